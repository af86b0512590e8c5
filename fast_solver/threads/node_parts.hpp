#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include <weft/fast_solver/network/network_kernel.hpp>
#include <weft/fast_solver/network/node_arrays.hpp>
#include <weft/fast_solver/threads/thread_team.hpp>

namespace weft::fast {

/// The nodes of a network in parts of about the same size, for the loops of a ThreadTeam and for sums: which they are
/// depends on the number of nodes alone, so that sums over parts have the same bits for any number of threads.
class NodeParts {
 public:
  NodeParts() = default;
  explicit NodeParts(int num_nodes)
      : num_lines_(fill_up(num_nodes) / kNodeLine),
        count_(std::clamp((num_lines_ + kLines / 2) / kLines, 1, ThreadTeam::kMostParts)) {}

  [[nodiscard]] int count() const { return count_; }
  [[nodiscard]] NodeRange operator[](int part) const { return {first(part), first(part + 1)}; }

 private:
  /// 640 nodes: some microseconds of each loop, ten times what it takes threads to wait for each other.
  static constexpr int kLines = 10;
  static_assert(kFewestToShare == (kLines + kLines / 2) * kNodeLine);

  [[nodiscard]] int first(int part) const {
    return static_cast<int>(std::int64_t{num_lines_} * part / count_) * kNodeLine;
  }

  int num_lines_ = 0;
  int count_ = 1;
};

/// work(part, begin, end) for each part of some nodes begin ... end - 1, by a team.
template <class Work>
void run_parts(ThreadTeam& team, int num_nodes, const Work& work) {
  const NodeParts parts(num_nodes);
  team.run(parts.count(), [parts, num_nodes, work](int part) {
    work(part, parts[part].begin, std::min(parts[part].end, num_nodes));
  });
}

/// Those of some nodes in ascending order that are in a range.
[[nodiscard]] inline std::span<const int> in_range(const std::vector<int>& sorted,
                                                   NodeRange nodes) {
  const auto begin = std::lower_bound(sorted.begin(), sorted.end(), nodes.begin);
  return {begin, std::lower_bound(begin, sorted.end(), nodes.end)};
}

}  // namespace weft::fast
