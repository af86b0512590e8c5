#pragma once

// Tested by tests/custom_forces/assembly/edge_assembly_test.cpp, tests/custom_forces/assembly/element_assembly_test.cpp.

#include <cstddef>
#include <vector>

#include <weft/core/eigen_alignment.hpp>

namespace weft::forces {

/// How elements (edges, hinges, triangles) are cut into pieces for threads.
///
/// Elements are put in the order of their lowest node, so that a piece is one region of the mesh,
/// and cut into equal chunks. A chunk sums into slots of its own, one for each node it touches.
/// Most nodes are touched by one chunk only, which adds its sum to the result itself; the others,
/// shared by neighboring chunks, are added up at the end in the order of the chunks.
///
/// Nothing here depends on the number of threads: the same elements give the same sums in the same
/// order, and so the same bits.
class ElementChunks {
 public:
  struct Chunk {
    Eigen::Index begin;  ///< first place in order()
    Eigen::Index end;    ///< one past the last
    Eigen::Index first_slot;
    Eigen::Index last_slot;  ///< one past the last
    [[nodiscard]] Eigen::Index num_slots() const { return last_slot - first_slot; }
  };
  using Elements = Eigen::Matrix<int, Eigen::Dynamic, Eigen::Dynamic>;

  /// elements: node indices in [0, num_nodes), one column per element. grain: about so many
  /// elements per chunk, > 0.
  ElementChunks(const Eigen::Ref<const Elements>& elements, int num_nodes, int grain);

  [[nodiscard]] int num_nodes() const { return num_nodes_; }
  [[nodiscard]] Eigen::Index num_slots() const {
    return static_cast<Eigen::Index>(slot_nodes_.size());
  }
  [[nodiscard]] const std::vector<Chunk>& chunks() const { return chunks_; }
  /// The element at each place; chunks are intervals of places.
  [[nodiscard]] const std::vector<int>& order() const { return order_; }
  /// Slot of each corner, one column per place.
  [[nodiscard]] const Elements& slots() const { return slots_; }
  /// Node of each slot, ascending within a chunk.
  [[nodiscard]] int node(Eigen::Index slot) const {
    return slot_nodes_[static_cast<std::size_t>(slot)];
  }
  /// Whether other chunks touch the slot's node too.
  [[nodiscard]] bool is_shared(Eigen::Index slot) const {
    return slot_is_shared_[static_cast<std::size_t>(slot)] != 0;
  }

  /// A node that several chunks touch, with its slots shared_slots()[first_slot ... last_slot) in
  /// the order of the chunks.
  struct SharedNode {
    int node;
    int first_slot;
    int last_slot;
  };
  [[nodiscard]] const std::vector<SharedNode>& shared_nodes() const { return shared_nodes_; }
  [[nodiscard]] const std::vector<int>& shared_slots() const { return shared_slots_; }

  /// Puts the places of one chunk into another order.
  void reorder(const Chunk& chunk, const std::vector<Eigen::Index>& places);

 private:
  void sort_by_lowest_node(const Eigen::Ref<const Elements>& elements);
  void cut(const Eigen::Ref<const Elements>& elements, int grain);
  void find_shared_nodes();

  int num_nodes_;
  std::vector<int> order_;
  Elements slots_;
  std::vector<Chunk> chunks_;
  std::vector<int> slot_nodes_;
  std::vector<char> slot_is_shared_;
  std::vector<SharedNode> shared_nodes_;
  std::vector<int> shared_slots_;
};

}  // namespace weft::forces
