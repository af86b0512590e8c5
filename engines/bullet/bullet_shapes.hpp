#pragma once

#include <memory>

#include <btBulletDynamicsCommon.h>

#include <weft/scenes/scene.hpp>

namespace weft::scenes {

/// A rigid body with its shape, as the scene describes it; every field that matters is set.
struct BulletCollider {
  std::shared_ptr<btCollisionShape> shape;  ///< owns its children and arrays too
  std::unique_ptr<btRigidBody> body;
};

[[nodiscard]] BulletCollider make_bullet_collider(const Collider& collider,
                                                  ConcaveContact concave = ConcaveContact::kPrisms);

/// Bullet's shape of a collider. Its origin lies at bullet_shape_offset() in the collider's frame.
[[nodiscard]] std::shared_ptr<btCollisionShape> make_bullet_shape(const Shape& shape,
                                                                  ConcaveContact concave);

/// Voxel edge [m] of Bullet's distance field that follows every collider of the scene well; for
/// colliders of less than a hundredth of a millimetre beside others, as fine as it may be: a
/// micrometre, and a ten millionth of the largest one.
[[nodiscard]] double distance_field_voxel(const Scene& scene);

/// Distance from the origin [m] up to which the distance field has numbers for its cells; farther out
/// Bullet would read beyond a cell.
[[nodiscard]] double distance_field_reach(const Scene& scene);

/// Where the origin of Bullet's body stands in the collider's frame [m]: Bullet's plane is a box
/// below it, and its bodies turn about their origin, which must be the centre of mass.
[[nodiscard]] Vector3<double> bullet_shape_offset(const Collider& collider);

}  // namespace weft::scenes
