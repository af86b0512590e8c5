#pragma once

#include <vector>

#include <weft/custom_forces/core/types.hpp>
#include <weft/fast_solver/network_kernel.hpp>
#include <weft/fast_solver/node_arrays.hpp>

namespace weft::fast {

/// The edges of a network as the processor's vectors want them: a block is kNodeBlock nodes in a row,
/// a slot one neighbour for each of them. On a grid the neighbours are in a row as well, at the same
/// distance from their nodes, so that whole vectors are loaded and stored. Other slots fetch their
/// neighbours one by one.
///
/// A mutual slot gives its neighbours the opposite force. An edge whose ends are in different tasks
/// has a lane at both: then tasks write to their own nodes only, and any number of threads gives the
/// same bits.
struct EdgeSlots {
  int num_nodes = 0;
  std::vector<int> block_starts;  ///< block b has slots block_starts[b] ... block_starts[b + 1] - 1
  std::vector<EdgeSlot> slots;
  std::vector<int> others;  ///< of each lane of each slot: the neighbour; an empty lane's own node
  std::vector<int> edges;   ///< of each lane of each slot: its edge, or -1
  std::vector<int> task_starts;  ///< task t has blocks task_starts[t] ... task_starts[t + 1] - 1

  [[nodiscard]] int num_slots() const { return static_cast<int>(slots.size()); }
  [[nodiscard]] int num_tasks() const { return static_cast<int>(task_starts.size()) - 1; }
};

/// edges: node indices in [0, num_nodes). blocks_per_task >= 1.
[[nodiscard]] EdgeSlots make_edge_slots(const Edges& edges, int num_nodes, int blocks_per_task);

}  // namespace weft::fast
