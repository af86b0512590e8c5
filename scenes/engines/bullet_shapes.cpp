#include <weft/scenes/engines/bullet_shapes.hpp>

#include <algorithm>

namespace weft::scenes {
namespace {

/// Bullet has no usable plane for soft bodies: btStaticPlaneShape is "concave" to it, which turns
/// the plane into triangles extruded by 6 cm that a node passes in one step at 6 m/s. A box is met
/// through its distance field at any depth. 40 m wide: single precision still resolves 4
/// micrometres at its rim; 5 m deep.
constexpr double kPlaneHalfWidth = 20.0;
constexpr double kPlaneHalfDepth = 2.5;

/// Bullet rounds a box by its margin (4 cm by default). As a fraction of the smallest half extent.
constexpr double kBoxMarginRatio = 0.01;

/// Voxel edge as a fraction of a collider's smallest half extent: 1/20 meets a sphere within R /
/// 3200.
constexpr double kVoxelRatio = 0.05;
constexpr double kLargestVoxel = 0.25;  ///< [m] Bullet's default

btVector3 to_bullet(const Vector3<double>& v) {
  const Vector3<btScalar> s = v.cast<btScalar>();
  return {s[0], s[1], s[2]};
}

std::unique_ptr<btCollisionShape> make_box(const Vector3<double>& half_extents) {
  auto box = std::make_unique<btBoxShape>(to_bullet(half_extents));
  box->setMargin(static_cast<btScalar>(kBoxMarginRatio * half_extents.minCoeff()));
  return box;
}

struct MakeShape {
  std::unique_ptr<btCollisionShape> operator()(const SphereShape& sphere) const {
    return std::make_unique<btSphereShape>(static_cast<btScalar>(sphere.radius));
  }
  std::unique_ptr<btCollisionShape> operator()(const BoxShape& box) const {
    return make_box(box.half_extents);
  }
  std::unique_ptr<btCollisionShape> operator()(const PlaneShape&) const {
    return make_box({kPlaneHalfWidth, kPlaneHalfDepth, kPlaneHalfWidth});
  }
};

struct SmallestHalfExtent {
  double operator()(const SphereShape& sphere) const { return sphere.radius; }
  double operator()(const BoxShape& box) const { return box.half_extents.minCoeff(); }
  double operator()(const PlaneShape&) const { return kLargestVoxel / kVoxelRatio; }
};

}  // namespace

double bullet_shape_offset(const Shape& shape) {
  return std::holds_alternative<PlaneShape>(shape) ? kPlaneHalfDepth : 0.0;
}

BulletCollider make_bullet_collider(const Collider& collider) {
  BulletCollider result;
  result.shape = std::visit(MakeShape{}, collider.shape);
  const auto mass = static_cast<btScalar>(collider.mass.value_or(0.0));
  btVector3 inertia(0, 0, 0);
  if (collider.mass) result.shape->calculateLocalInertia(mass, inertia);
  btRigidBody::btRigidBodyConstructionInfo info(mass, nullptr, result.shape.get(), inertia);
  const Eigen::Quaternion<btScalar> q = collider.orientation.cast<btScalar>();
  const Vector3<double> down =
      collider.orientation * Vector3<double>(0, -bullet_shape_offset(collider.shape), 0);
  info.m_startWorldTransform =
      btTransform(btQuaternion(q.x(), q.y(), q.z(), q.w()), to_bullet(collider.position + down));
  info.m_friction = static_cast<btScalar>(collider.friction);
  info.m_restitution = 0;
  info.m_linearDamping = 0;
  info.m_angularDamping = 0;
  info.m_rollingFriction = 0;
  info.m_spinningFriction = 0;
  result.body = std::make_unique<btRigidBody>(info);
  if (collider.mass) {
    result.body->setLinearVelocity(to_bullet(collider.velocity));
    result.body->setAngularVelocity(to_bullet(collider.angular_velocity));
  }
  if (collider.path) {
    result.body->setCollisionFlags(result.body->getCollisionFlags() |
                                   btCollisionObject::CF_KINEMATIC_OBJECT);
  }
  result.body->setActivationState(DISABLE_DEACTIVATION);
  return result;
}

double distance_field_voxel(const Scene& scene) {
  double voxel = kLargestVoxel;
  for (const Collider& collider : scene.colliders) {
    voxel = std::min(voxel, kVoxelRatio * std::visit(SmallestHalfExtent{}, collider.shape));
  }
  return voxel;
}

}  // namespace weft::scenes
