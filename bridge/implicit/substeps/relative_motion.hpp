#pragma once

// Tested by tests/bridge/implicit/substeps/relative_motion_test.cpp.

#include <span>
#include <vector>

#include <weft/bridge/bullet/precision.hpp>
#include <weft/bridge/contact/rigid_contacts.hpp>
#include <weft/core/types.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

/// The mean velocity with which dynamic bodies move with respect to the nodes that they meet. Nodes that shake, or that turn with a
/// body which they hang on, have speed, but the body does not come towards them.
class RelativeMotion {
 public:
  /// contacts: of all nodes. velocities: of the nodes, 3 x n [m/s].
  RelativeMotion(std::span<const RigidContact> contacts, const Matrix3X<btScalar>& velocities);
  /// [m/s], of the body of one of these contacts; zero for objects that no impulse moves.
  [[nodiscard]] btVector3 of(const RigidContact& contact) const;

 private:
  struct Sum {
    btVector3 velocities{0, 0, 0};
    int count = 0;
  };
  std::vector<Sum> of_collider_;  ///< by RigidContact::collider
};

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
