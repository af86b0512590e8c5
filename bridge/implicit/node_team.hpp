#pragma once

// Tested by tests/bridge/implicit/fast_body_threads_test.cpp.

#include <algorithm>
#include <optional>

#include <weft/bridge/bullet/precision.hpp>
#include <weft/fast_solver/threads/node_partition.hpp>
#include <weft/fast_solver/threads/worker_team.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

/// Threads that work on the nodes of one body.
class NodeTeam {
 public:
  /// That may work at a time, with the one that calls.
  void set_num_threads(int num_threads) { num_threads_ = num_threads; }
  /// They stay as long as the scope has them: between the stages of a step too.
  [[nodiscard]] fast::WorkerTeam::Scope hold_threads() { return {team_, team_size()}; }
  void hold_threads(std::optional<fast::WorkerTeam::Scope>& scope) {
    scope.emplace(team_, team_size());
  }
  /// work(first node, number of nodes) for each range of the nodes, by the threads.
  template <class Work>
  void for_nodes(const Work& work) {
    fast::run_parts(team_, num_nodes_, [&](int, int begin, int end) { work(begin, end - begin); });
  }

 protected:
  void set_num_nodes(Eigen::Index num_nodes) { num_nodes_ = static_cast<int>(num_nodes); }
  /// Two ranges per thread: with one each, threads lose by waiting for one another what they gain.
  [[nodiscard]] int team_size() const {
    return std::clamp(fast::NodePartition(num_nodes_).count() / 2, 1, num_threads_);
  }

  fast::WorkerTeam team_;

 private:
  int num_threads_ = 1;
  int num_nodes_ = 0;
};

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
