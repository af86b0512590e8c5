#pragma once

// Tested by tests/fast_solver/threads/node_partition_test.cpp, tests/fast_solver/torn_network_test.cpp.

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include <weft/fast_solver/network/network_kernel.hpp>
#include <weft/fast_solver/network/node_arrays.hpp>
#include <weft/fast_solver/threads/worker_team.hpp>

namespace weft::fast {

/// Splits the nodes of a network into ranges of about the same size, for loops of a WorkerTeam and for sums. The ranges depend
/// only on the number of nodes, so that sums over them have the same bits for any number of threads.
class NodePartition {
 public:
  NodePartition() = default;
  explicit NodePartition(int num_nodes)
      : num_blocks_((num_nodes + kNodeBlock - 1) / kNodeBlock),
        count_(std::clamp((num_cache_lines() + kCacheLinesPerRange / 2) / kCacheLinesPerRange, 1,
                          WorkerTeam::kMostParts)) {}

  [[nodiscard]] int count() const { return count_; }
  /// The last one ends with the last block of nodes: what pads a line of the cache behind it is zero, and as much work as the
  /// nodes themselves if there are few.
  [[nodiscard]] NodeRange operator[](int part) const {
    return {first(part), std::min(first(part + 1), num_blocks_ * kNodeBlock)};
  }

 private:
  /// 640 nodes: some microseconds of each loop, ten times what it takes threads to wait for each other.
  static constexpr int kCacheLinesPerRange = 10;
  static_assert(kFewestToShare ==
                (kCacheLinesPerRange + kCacheLinesPerRange / 2) * kNodesPerCacheLine);

  [[nodiscard]] int num_cache_lines() const {
    return padded_size(num_blocks_ * kNodeBlock) / kNodesPerCacheLine;
  }
  [[nodiscard]] int first(int part) const {
    return static_cast<int>(std::int64_t{num_cache_lines()} * part / count_) * kNodesPerCacheLine;
  }

  int num_blocks_ = 0;
  int count_ = 1;
};

/// work(part, begin, end) for each part of some nodes begin ... end - 1, by a team.
template <class Work>
void run_parts(WorkerTeam& team, int num_nodes, const Work& work) {
  const NodePartition parts(num_nodes);
  team.run(parts.count(), [parts, num_nodes, work](int part) {
    work(part, parts[part].begin, std::min(parts[part].end, num_nodes));
  });
}

/// The nodes of an ascending list that lie in a range.
[[nodiscard]] inline std::span<const int> in_range(const std::vector<int>& sorted,
                                                   NodeRange nodes) {
  const auto begin = std::lower_bound(sorted.begin(), sorted.end(), nodes.begin);
  return {begin, std::lower_bound(begin, sorted.end(), nodes.end)};
}

}  // namespace weft::fast
