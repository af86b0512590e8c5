#pragma once

// Tested by tests/bridge/implicit/substeps/pin_pull_test.cpp.

#include <span>
#include <vector>

#include <weft/bridge/bullet/precision.hpp>
#include <weft/bridge/contact/rigid_contacts.hpp>
#include <weft/core/types.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

/// How far pins that a program has moved pull cloth from under what presses it in one step. At once, it would be a blow.
class PinPull {
 public:
  /// ends: where the last step has left the nodes; starts: where they are now, pins moved; both 3 x n [m], or of unlike sizes if
  /// the last step was of other nodes. contacts: of all nodes.
  PinPull(std::span<const int> pins, const Matrix3X<btScalar>& ends,
          const Matrix3X<btScalar>& starts, std::span<const RigidContact> contacts);
  /// How far the pin that has moved the most leaves a node with contacts, which goes by way [m]; at most twice as far as the pin moves. Zero
  /// if not two objects touch the node.
  [[nodiscard]] btScalar on(int node, const Vector3<btScalar>& way) const;

 private:
  Vector3<btScalar> motion_ = Vector3<btScalar>::Zero();  ///< of that pin [m]
  std::vector<char> is_between_;                          ///< for each node; empty: no pin moves
};

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
