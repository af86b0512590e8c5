#pragma once

// Tested by tests/bridge/implicit/substeps/pin_pull_test.cpp.

#include <span>

#include <weft/bridge/bullet/precision.hpp>
#include <weft/bridge/contact/rigid_contacts.hpp>
#include <weft/core/types.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

/// How far pins that a program has moved pull cloth from under what presses it in one step. At once, it would be a blow.
class PinPull {
 public:
  /// ends: where the last step has left the nodes; starts: where they are now, pins moved; both 3 x n [m], or of unlike sizes if
  /// the last step was of other nodes.
  PinPull(std::span<const int> pins, const Matrix3X<btScalar>& ends,
          const Matrix3X<btScalar>& starts);
  /// How far the pin that has moved the most leaves the node of a contact, which goes by way [m]. Zero if nothing else is behind the node.
  [[nodiscard]] btScalar on(const RigidContact& contact, const Vector3<btScalar>& way,
                            std::span<const RigidContact> contacts) const;

 private:
  Vector3<btScalar> motion_ = Vector3<btScalar>::Zero();  ///< of that pin [m]
};

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
