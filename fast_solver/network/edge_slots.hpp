#pragma once

#include <vector>

#include <weft/core/types.hpp>
#include <weft/fast_solver/network/network_kernel.hpp>
#include <weft/fast_solver/network/node_arrays.hpp>

namespace weft::fast {

/// The edges of a network as the processor's vectors want them: a block is kNodeBlock nodes in a row,
/// a slot one neighbor for each of them. On a grid the neighbors are in a row as well, at the same
/// distance from their nodes, so that whole vectors are loaded. Other slots fetch their neighbors one
/// by one.
///
/// Every edge has a lane at both ends: to add the opposite force to a neighbor would mean to read,
/// change and write vectors across cache lines, which takes longer than to compute it twice. So
/// nothing is written but a block's own nodes, and any number of threads gives the same bits.
struct EdgeSlots {
  int num_nodes = 0;
  std::vector<SlotRange> blocks;
  std::vector<EdgeSlot> slots;
  std::vector<int> others;  ///< of each lane of each slot: the neighbor; an empty lane's own node
  std::vector<int> edges;   ///< of each lane of each slot: its edge, or -1

  [[nodiscard]] int num_slots() const { return static_cast<int>(slots.size()); }
  [[nodiscard]] int num_blocks() const { return static_cast<int>(blocks.size()); }
};

/// edges: node indices in [0, num_nodes).
[[nodiscard]] EdgeSlots make_edge_slots(const Edges& edges, int num_nodes);

/// An edge as one of its ends sees it.
struct EdgeLane {
  int node;
  int other;
  int edge;
};

/// Puts the lanes of block after block into slots.
class SlotMaker {
 public:
  /// Appends a block with these lanes of its nodes to slots, whose num_nodes is set.
  void append(int block, const std::vector<EdgeLane>& lanes, EdgeSlots& slots);

 private:
  /// A neighbor at the same distance for each node; -1: none.
  struct Row {
    int offset;
    int num_lanes;
    int lanes[kNodeBlock];
  };
  Row& row_at(int offset);
  void sort_into_rows(int first, const std::vector<EdgeLane>& lanes, int num_nodes);
  void add_scattered(int first, const std::vector<EdgeLane>& lanes, EdgeSlots& slots);

  std::vector<Row> rows_;
  std::size_t next_row_ = 0;  ///< on a grid, lanes come in the same order for each node
  std::vector<int> rest_;     ///< lanes that no row has
};

}  // namespace weft::fast
