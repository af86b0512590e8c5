#pragma once

// Tested by tests/bridge/implicit/substeps/mean_velocities_test.cpp.

#include <span>
#include <vector>

#include <weft/bridge/bullet/bullet_vector.hpp>
#include <weft/bridge/bullet/precision.hpp>
#include <weft/bridge/contact/rigid_contacts.hpp>
#include <weft/core/types.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

/// The mean velocity of the nodes that each object meets. Cloth that shakes has speed, but does not come towards the object.
class MeanVelocities {
 public:
  /// contacts: of all nodes. velocities: of the nodes, 3 x n [m/s].
  MeanVelocities(std::span<const RigidContact> contacts, const Matrix3X<btScalar>& velocities);
  /// [m/s], of the nodes that meet the object of one of these contacts.
  [[nodiscard]] btVector3 at(const RigidContact& contact) const;

 private:
  struct Sum {
    Vector3<btScalar> velocities = Vector3<btScalar>::Zero();
    int count = 0;
  };
  std::vector<Sum> of_collider_;  ///< by RigidContact::collider
};

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
