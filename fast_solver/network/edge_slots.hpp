#pragma once

#include <vector>

#include <weft/core/types.hpp>
#include <weft/fast_solver/network/network_kernel.hpp>
#include <weft/fast_solver/network/node_arrays.hpp>

namespace weft::fast {

/// The edges of a network in a sliced ELLPACK layout (Kreutzer et al. 2014). A slice is a block of kNodeBlock consecutive nodes,
/// and a slot holds one neighbor for each of them, one per lane. On a grid the neighbors are consecutive as well, so that whole
/// vectors are loaded. Other slots gather their neighbors one by one.
///
/// Every edge has a lane at both ends and is computed twice. That is faster than scattering the opposite force across cache lines. It
/// also gives the same bits for any number of threads, because only a block's own nodes are written.
struct EdgeSlots {
  int num_nodes = 0;
  std::vector<SlotRange> blocks;
  std::vector<EdgeSlot> slots;
  std::vector<int> others;  ///< for each lane of each slot: the neighbor; an empty lane's own node
  std::vector<int> edges;   ///< for each lane of each slot: its edge, or -1

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
