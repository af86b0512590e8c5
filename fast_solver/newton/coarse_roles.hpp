#pragma once

// Tested by tests/fast_solver/newton/coarse_roles_test.cpp.

#include <algorithm>
#include <cstddef>
#include <vector>

#include <weft/core/index.hpp>
#include <weft/fast_solver/linked_body.hpp>
#include <weft/fast_solver/node_constraints.hpp>

namespace weft::fast {

/// What constrained nodes are for the coarse correction. Those that slide on what nothing moves take part in it. Those that are
/// fixed do not, nor do those on bodies, which move with these: as two parts of one sum, both would find the motion of a body, and
/// the sum too much.
class CoarseRoles {
 public:
  /// constrained: nodes, ascending; states: of all nodes; sliding(node) is what a node that slides is given as.
  template <class Sliding>
  void set(const std::vector<int>& constrained, const std::vector<BodyLink>& links,
           const std::vector<ContactState>& states, const Sliding& sliding) {
    for (const int node : held_) is_held_[at(node)] = 0;
    is_held_.resize(states.size());
    held_.clear();
    sliding_.clear();
    for (const BodyLink& link : links) is_held_[at(link.node)] = 1;
    for (const int node : constrained) {
      if (states[at(node)] == ContactState::kOnPlane && is_held_[at(node)] == 0) {
        sliding_.push_back(sliding(node));
      } else {
        is_held_[at(node)] = 1;
        held_.push_back(node);
      }
    }
  }

  /// Whether some nodes slide on parallel planes and nothing holds the others: along these planes the whole moves without strain.
  [[nodiscard]] bool slide_as_a_whole() const {
    constexpr float kParallel = 1e-4F;
    if (sliding_.empty() || !held_.empty()) return false;
    const Vector3<float>& first = sliding_.front().normal;
    return std::all_of(sliding_.begin(), sliding_.end(), [&first](const SlidingNode& one) {
      return (one.normal - first).norm() <= kParallel;
    });
  }
  /// Nodes that slide, ascending.
  [[nodiscard]] const std::vector<SlidingNode>& sliding() const { return sliding_; }
  /// Nodes that have no part, ascending; and whether each node is one of them.
  [[nodiscard]] const std::vector<int>& held() const { return held_; }
  [[nodiscard]] const std::vector<char>& is_held() const { return is_held_; }

 private:
  std::vector<SlidingNode> sliding_;
  std::vector<int> held_;
  std::vector<char> is_held_;
};

}  // namespace weft::fast
