#include <weft/custom_forces/element_chunks.hpp>

#include <algorithm>
#include <numeric>

namespace weft::forces {
namespace {

/// Equal pieces for two and for four threads.
constexpr Eigen::Index kPiecesMultiple = 4;

Eigen::Index num_pieces(Eigen::Index num_elements, int grain) {
  const Eigen::Index pieces = (num_elements + grain - 1) / grain;
  if (pieces <= kPiecesMultiple) return pieces;
  return std::min((pieces + kPiecesMultiple - 1) / kPiecesMultiple * kPiecesMultiple, num_elements);
}

}  // namespace

ElementChunks::ElementChunks(const Eigen::Ref<const Elements>& elements, int num_nodes, int grain)
    : num_nodes_(num_nodes),
      order_(static_cast<std::size_t>(elements.cols())),
      slots_(elements.rows(), elements.cols()) {
  std::vector<int> lowest(order_.size());
  for (std::size_t e = 0; e < lowest.size(); ++e) {
    lowest[e] = elements.col(static_cast<Eigen::Index>(e)).minCoeff();
  }
  std::iota(order_.begin(), order_.end(), 0);
  std::stable_sort(order_.begin(), order_.end(), [&](int a, int b) {
    return lowest[static_cast<std::size_t>(a)] < lowest[static_cast<std::size_t>(b)];
  });
  cut(elements, grain);
  find_shared_nodes();
}

void ElementChunks::cut(const Eigen::Ref<const Elements>& elements, int grain) {
  const Eigen::Index num_elements = elements.cols();
  const Eigen::Index pieces = num_pieces(num_elements, grain);
  std::vector<int> slot_of_node(static_cast<std::size_t>(num_nodes_));
  for (Eigen::Index c = 0; c < pieces; ++c) {
    Chunk chunk{num_elements * c / pieces, num_elements * (c + 1) / pieces, num_slots(), 0};
    std::vector<int> nodes;
    for (Eigen::Index place = chunk.begin; place < chunk.end; ++place) {
      const auto element = elements.col(order_[static_cast<std::size_t>(place)]);
      nodes.insert(nodes.end(), element.begin(), element.end());
    }
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
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
  std::vector<std::vector<int>> slots_of_node(static_cast<std::size_t>(num_nodes_));
  for (std::size_t slot = 0; slot < slot_nodes_.size(); ++slot) {
    slots_of_node[static_cast<std::size_t>(slot_nodes_[slot])].push_back(static_cast<int>(slot));
  }
  slot_is_shared_.assign(slot_nodes_.size(), 0);
  for (int node = 0; node < num_nodes_; ++node) {
    const std::vector<int>& slots = slots_of_node[static_cast<std::size_t>(node)];
    if (slots.size() < 2) continue;
    const int first = static_cast<int>(shared_slots_.size());
    shared_slots_.insert(shared_slots_.end(), slots.begin(), slots.end());
    shared_nodes_.push_back({node, first, static_cast<int>(shared_slots_.size())});
    for (const int slot : slots) slot_is_shared_[static_cast<std::size_t>(slot)] = 1;
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
