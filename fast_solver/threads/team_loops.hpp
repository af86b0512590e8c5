#pragma once

// Tested by tests/fast_solver/implicit_solver_test.cpp.

#include <array>
#include <numeric>

#include <weft/fast_solver/threads/node_partition.hpp>
#include <weft/fast_solver/threads/worker_team.hpp>

namespace weft::fast {

/// Loops over the parts of the nodes of one solver, by the team that works on it.
class TeamLoops {
 protected:
  /// work(nodes) for each part of the nodes. What it has by value goes to workers with it (WorkerTeam::run).
  template <class Work>
  void for_each_part(const Work& work) {
    team_->run(parts_.count(), [parts = parts_, work](int part) { work(parts[part]); });
  }
  /// Sum of term(nodes), which is a Sum, over the parts in order.
  template <class Sum = double, class Term>
  [[nodiscard]] Sum sum_over_parts(const Term& term) {
    std::array<Sum, WorkerTeam::kMostParts> sums;
    team_->run(parts_.count(), [parts = parts_, sums = sums.data(), term](int part) {
      sums[part] = term(parts[part]);
    });
    return std::accumulate(sums.begin() + 1, sums.begin() + parts_.count(), sums[0]);
  }

  WorkerTeam* team_ = nullptr;  ///< while there is work to do
  NodePartition parts_;
};

}  // namespace weft::fast
