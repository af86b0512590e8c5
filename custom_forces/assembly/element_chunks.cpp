#include <weft/custom_forces/assembly/element_chunks.hpp>

#include <algorithm>
#include <numeric>

namespace weft::forces {
namespace {

/// More pieces than two are equal shares for two and for four threads.
constexpr Eigen::Index kPiecesMultiple = 4;

Eigen::Index num_pieces(Eigen::Index num_elements, int grain) {
  const Eigen::Index pieces = (num_elements + grain - 1) / grain;
  if (pieces <= 2) return pieces;
  return std::min((pieces + kPiecesMultiple - 1) / kPiecesMultiple * kPiecesMultiple, num_elements);
}

}  // namespace

ElementChunks::ElementChunks(const Eigen::Ref<const Elements>& elements, int num_nodes, int grain)
    : num_nodes_(num_nodes),
      order_(static_cast<std::size_t>(elements.cols())),
      slots_(elements.rows(), elements.cols()) {
  sort_by_lowest_node(elements);
  cut(elements, grain);
  find_shared_nodes();
}

// By counting: laws are made anew when a cloth tears, between two frames.
void ElementChunks::sort_by_lowest_node(const Eigen::Ref<const Elements>& elements) {
  std::vector<int> lowest(order_.size());
  std::vector<std::size_t> next(static_cast<std::size_t>(num_nodes_) + 1, 0);
  for (std::size_t e = 0; e < lowest.size(); ++e) {
    lowest[e] = elements.col(static_cast<Eigen::Index>(e)).minCoeff();
    ++next[static_cast<std::size_t>(lowest[e]) + 1];
  }
  std::partial_sum(next.begin(), next.end(), next.begin());
  for (std::size_t e = 0; e < lowest.size(); ++e) {
    order_[next[static_cast<std::size_t>(lowest[e])]++] = static_cast<int>(e);
  }
}

void ElementChunks::cut(const Eigen::Ref<const Elements>& elements, int grain) {
  const Eigen::Index num_elements = elements.cols();
  const Eigen::Index pieces = num_pieces(num_elements, grain);
  std::vector<int> slot_of_node(static_cast<std::size_t>(num_nodes_), -1);
  std::vector<int> nodes;
  for (Eigen::Index c = 0; c < pieces; ++c) {
    Chunk chunk{num_elements * c / pieces, num_elements * (c + 1) / pieces, num_slots(), 0};
    nodes.clear();
    for (Eigen::Index place = chunk.begin; place < chunk.end; ++place) {
      for (const int node : elements.col(order_[static_cast<std::size_t>(place)])) {
        int& slot = slot_of_node[static_cast<std::size_t>(node)];
        if (slot >= static_cast<int>(chunk.first_slot)) continue;
        slot = static_cast<int>(chunk.first_slot);  // seen; its own one follows
        nodes.push_back(node);
      }
    }
    std::sort(nodes.begin(), nodes.end());
    for (const int node : nodes) {
      slot_of_node[static_cast<std::size_t>(node)] = static_cast<int>(slot_nodes_.size());
      slot_nodes_.push_back(node);
    }
    for (Eigen::Index place = chunk.begin; place < chunk.end; ++place) {
      for (Eigen::Index corner = 0; corner < elements.rows(); ++corner) {
        const int node = elements(corner, order_[static_cast<std::size_t>(place)]);
        slots_(corner, place) = slot_of_node[static_cast<std::size_t>(node)];
      }
    }
    chunk.last_slot = num_slots();
    chunks_.push_back(chunk);
  }
}

void ElementChunks::find_shared_nodes() {
  std::vector<int> num_slots_of(static_cast<std::size_t>(num_nodes_), 0);
  for (const int node : slot_nodes_) ++num_slots_of[static_cast<std::size_t>(node)];
  std::vector<int> next(num_slots_of.size(), -1);  // in shared_slots_, of each shared node
  int num_shared = 0;
  for (int node = 0; node < num_nodes_; ++node) {
    const int count = num_slots_of[static_cast<std::size_t>(node)];
    if (count < 2) continue;
    shared_nodes_.push_back({node, num_shared, num_shared + count});
    next[static_cast<std::size_t>(node)] = num_shared;
    num_shared += count;
  }
  shared_slots_.resize(static_cast<std::size_t>(num_shared));
  slot_is_shared_.assign(slot_nodes_.size(), 0);
  for (std::size_t slot = 0; slot < slot_nodes_.size(); ++slot) {
    int& place = next[static_cast<std::size_t>(slot_nodes_[slot])];
    if (place < 0) continue;
    shared_slots_[static_cast<std::size_t>(place++)] = static_cast<int>(slot);
    slot_is_shared_[slot] = 1;
  }
}

void ElementChunks::reorder(const Chunk& chunk, const std::vector<Eigen::Index>& places) {
  const std::vector<int> old_order(order_.begin() + chunk.begin, order_.begin() + chunk.end);
  const Elements old_slots = slots_.middleCols(chunk.begin, chunk.end - chunk.begin);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const Eigen::Index place = chunk.begin + static_cast<Eigen::Index>(i);
    const Eigen::Index old_place = places[i] - chunk.begin;
    order_[static_cast<std::size_t>(place)] = old_order[static_cast<std::size_t>(old_place)];
    slots_.col(place) = old_slots.col(old_place);
  }
}

}  // namespace weft::forces
