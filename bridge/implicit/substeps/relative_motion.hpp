#pragma once

// Tested by tests/bridge/implicit/substeps/relative_motion_test.cpp.

#include <span>
#include <vector>

#include <weft/bridge/bullet/precision.hpp>
#include <weft/bridge/contact/rigid_contacts.hpp>
#include <weft/bridge/rigid/movable_object.hpp>
#include <weft/core/types.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

/// How dynamic bodies move with respect to the nodes that they meet: for each body, the rigid velocity field that fits the relative
/// velocities best (least squares). Nodes that shake have speed, but neither they nor the body come any nearer.
class RelativeMotion {
 public:
  /// contacts: of all nodes. velocities: of the nodes, 3 x n [m/s].
  RelativeMotion(std::span<const RigidContact> contacts, const Matrix3X<btScalar>& velocities);
  /// [m/s], where the body of one of these contacts meets its node; zero for objects that no impulse moves.
  [[nodiscard]] btVector3 at(const RigidContact& contact) const;

 private:
  std::vector<RigidVelocity> of_collider_;  ///< by RigidContact::collider
};

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
