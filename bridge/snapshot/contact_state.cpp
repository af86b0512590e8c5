// A snapshot has this of the search for contacts: how nodes and faces were sorted when they were first looked at. Contacts are
// found in that order.
// Tested by tests/bridge/snapshot_test.cpp, tests/engines/snapshot_test.cpp.
#include <bit>
#include <cstdint>
#include <string>

#include <weft/bridge/contact/cloth_contact.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {
namespace {

/// Numbers below a limit, in as few bytes as they need.
template <class Stored>
void serialize_as(StateArchive& archive, std::vector<int>& numbers) {
  std::vector<Stored> stored(numbers.begin(), numbers.end());
  archive.value(stored);
  numbers.assign(stored.begin(), stored.end());
}

/// A permutation of 0 to num - 1, or nothing.
void serialize_order(StateArchive& archive, int num, std::vector<int>& order) {
  if (num <= 0xffff) {
    serialize_as<std::uint16_t>(archive, order);
  } else {
    archive.value(order);
  }
  if (!archive.is_reading()) return;
  std::vector<char> is_there(static_cast<std::size_t>(num), 0);
  bool is_permutation = order.empty() || order.size() == is_there.size();
  for (const int number : order) {
    is_permutation = is_permutation && number >= 0 && number < num &&
                     is_there[static_cast<std::size_t>(number)]++ == 0;
  }
  if (!is_permutation)
    archive.refuse("an order is none of all " + std::to_string(num) + " elements");
}

/// The starts of groups, of which none has more than most elements.
void serialize_starts(StateArchive& archive, std::size_t num, std::size_t most,
                      std::vector<std::size_t>& starts) {
  std::vector<std::uint8_t> sizes;
  for (std::size_t g = 0; g + 1 < starts.size(); ++g) {
    sizes.push_back(static_cast<std::uint8_t>(starts[g + 1] - starts[g]));
  }
  archive.value(sizes);
  if (!archive.is_reading()) return;
  starts.clear();
  if (sizes.empty()) return;
  starts.push_back(0);
  bool fits = true;
  for (const std::uint8_t size : sizes) {
    fits = fits && size <= most;
    starts.push_back(starts.back() + size);
  }
  if (!fits || starts.back() != num) archive.refuse("groups do not fit their elements");
}

}  // namespace

void NodeGroups::serialize(StateArchive& archive, int num_nodes) {
  static_assert(kLargest <= 0xff);
  archive.part("groups of nodes");
  if (static_cast<int>(nodes_.size()) !=
      num_nodes) {  // of a body before it tore: made anew at their next use
    nodes_.clear();
    starts_.clear();
  }
  serialize_order(archive, num_nodes, nodes_);
  serialize_starts(archive, nodes_.size(), kLargest, starts_);
}

void FaceTree::serialize(StateArchive& archive, int num_faces) {
  static_assert(kWidth <= 0xff);
  archive.part("tree of faces");
  std::vector<int> order;
  std::vector<std::size_t> starts;
  if (!leaves_.empty()) starts.push_back(0);
  for (const Leaf& leaf : leaves_) {
    order.insert(order.end(), leaf.faces.begin(),
                 leaf.faces.begin() + static_cast<std::ptrdiff_t>(leaf.size));
    starts.push_back(order.size());
  }
  serialize_order(archive, num_faces, order);
  serialize_starts(archive, order.size(), kWidth, starts);
  if (!archive.is_reading()) return;
  if (!order.empty() && !std::has_single_bit(starts.size() - 1)) {
    archive.refuse(std::to_string(starts.size() - 1) + " leaves, expected a power of two");
  }
  leaves_.clear();
  corners_.clear();
  if (!order.empty()) make_leaves(order, starts);
}

void ClothContact::serialize(StateArchive& archive, const btSoftBody& body) {
  archive.part("contact of cloth");
  archive.expect(settings_.with_itself, "contact with itself");
  archive.expect(near_at_rest_.size(), "nodes that have contact with their own cloth");
  tree_.serialize(archive, body.m_faces.size());
  groups_.serialize(archive, body.m_nodes.size());
  bool is_torn = flat_.is_forgotten();
  archive.value(is_torn);
  if (is_torn) {
    flat_.forget();
    windows_.forget();
  }
  is_of_this_step_ = false;
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
