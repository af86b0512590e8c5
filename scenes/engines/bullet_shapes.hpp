#pragma once

#include <memory>

#include <btBulletDynamicsCommon.h>

#include <weft/scenes/scene.hpp>

namespace weft::scenes {

/// A rigid body with its shape, as the scene describes it; every field that matters is set.
struct BulletCollider {
  std::unique_ptr<btCollisionShape> shape;
  std::unique_ptr<btRigidBody> body;
};

[[nodiscard]] BulletCollider make_bullet_collider(const Collider& collider);

/// Voxel edge [m] of Bullet's distance field that follows every collider of the scene well.
[[nodiscard]] double distance_field_voxel(const Scene& scene);

/// Bullet's body for a plane is a box below it; this is how far its centre lies under the plane
/// [m].
[[nodiscard]] double bullet_shape_offset(const Shape& shape);

}  // namespace weft::scenes
