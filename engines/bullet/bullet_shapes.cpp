#include <weft/engines/bullet/bullet_shapes.hpp>

#include <algorithm>
#include <vector>

#include <weft/bridge/bullet/bullet_vector.hpp>
#include <weft/engines/bullet/bullet_concave.hpp>
#include <weft/scenes/shapes/shape_surface.hpp>

namespace weft::scenes {
namespace {

using bridge::to_bullet;

/// Bullet has no usable plane for soft bodies: btStaticPlaneShape is "concave" to it, which turns
/// the plane into triangles extruded by 6 cm that a node passes in one step at 6 m/s. A box is met
/// through its distance field at any depth. 40 m wide: single precision still resolves 4
/// micrometres at its rim; 5 m deep.
constexpr double kPlaneHalfWidth = 20.0;
constexpr double kPlaneHalfDepth = 2.5;

/// Bullet rounds a box or a cylinder by its margin (4 cm by default). As a fraction of the smallest
/// half extent.
constexpr double kRoundingRatio = 0.01;
/// A cone and a hull grow by their margin instead. Without any, Bullet's search for the depth of a
/// point fails in places: then the field has no value there. As a fraction of the smallest half
/// extent.
constexpr double kGrowthRatio = 0.002;

/// Voxel edge as a fraction of a collider's smallest half extent: 1/20 meets a sphere within R /
/// 3200.
constexpr double kVoxelRatio = 0.05;
/// A capsule is met within R / 512: it has no edges, and a character has a dozen of them, whose cells
/// are what a run mostly computes if they are finer.
constexpr double kCapsuleVoxelRatio = 0.125;
/// The same for the edges of a mesh's triangles: their fronts are flat, and only bends between them
/// are rounded, by about a quarter of a voxel.
constexpr double kMeshVoxelRatio = 0.25;
/// A height field's prisms are few and deep: a finer field costs little.
constexpr double kFieldVoxelRatio = 0.15;
constexpr double kLargestVoxel = 0.25;   ///< [m] Bullet's default
constexpr double kSmallestVoxel = 1e-6;  ///< [m]
/// Voxel edge as a fraction of the largest collider, at least: about what single precision resolves.
constexpr double kSmallestVoxelRatio = 1e-7;
/// Bullet counts cells of four voxels in int; the rest leaves room for the collider's own place.
constexpr double kMaxVoxels = 1e9;

btQuaternion in_bullet(const Eigen::Quaterniond& orientation) {
  const Eigen::Quaternion<btScalar> q = orientation.cast<btScalar>();
  return {q.x(), q.y(), q.z(), q.w()};
}

double smallest_half_extent(const Matrix3X<double>& points) {
  return 0.5 * (points.rowwise().maxCoeff() - points.rowwise().minCoeff()).minCoeff();
}

struct SmallestHalfExtent {
  double operator()(const SphereShape& s) const { return s.radius; }
  double operator()(const BoxShape& s) const { return s.half_extents.minCoeff(); }
  double operator()(const CapsuleShape& s) const { return s.radius; }
  double operator()(const CylinderShape& s) const { return std::min(s.radius, 0.5 * s.height); }
  double operator()(const ConeShape& s) const { return std::min(s.radius, 0.5 * s.height); }
  double operator()(const ConvexHullShape& s) const { return smallest_half_extent(s.points); }
};

struct Voxel {
  double operator()(const PlaneShape&) const { return kLargestVoxel; }
  double operator()(const MeshShape& s) const { return kMeshVoxelRatio * mean_edge_length(s); }
  double operator()(const HeightFieldShape& s) const {
    return kFieldVoxelRatio * mean_edge_length(height_field_surface(s));
  }
  double operator()(const CompoundShape& s) const {
    double voxel = kLargestVoxel;
    for (const CompoundPart& part : s.parts) {
      voxel = std::min(voxel, kVoxelRatio * std::visit(SmallestHalfExtent{}, part.shape));
    }
    return voxel;
  }
  double operator()(const CapsuleShape& s) const { return kCapsuleVoxelRatio * s.radius; }
  template <class Convex>
  double operator()(const Convex& s) const {
    return kVoxelRatio * SmallestHalfExtent{}(s);
  }
};

/// Distance of the farthest point from the origin, roughly [m].
struct LargestExtent {
  double operator()(const SphereShape& s) const { return s.radius; }
  double operator()(const BoxShape& s) const { return s.half_extents.norm(); }
  double operator()(const PlaneShape&) const { return 2 * kPlaneHalfWidth; }
  double operator()(const CapsuleShape& s) const { return s.radius + s.height; }
  double operator()(const CylinderShape& s) const { return s.radius + s.height; }
  double operator()(const ConeShape& s) const { return s.radius + s.height; }
  double operator()(const ConvexHullShape& s) const { return s.points.cwiseAbs().maxCoeff(); }
  double operator()(const MeshShape& s) const { return s.points.cwiseAbs().maxCoeff(); }
  double operator()(const HeightFieldShape& s) const { return (*this)(height_field_surface(s)); }
  double operator()(const CompoundShape& s) const {
    double extent = 0.0;
    for (const CompoundPart& part : s.parts) {
      extent = std::max(extent, part.position.norm() + std::visit(*this, part.shape));
    }
    return extent;
  }
};

/// A compound and the children that it does not own itself.
struct OwnedCompound {
  std::vector<std::shared_ptr<btCollisionShape>> children;
  btCompoundShape compound;

  void add(std::shared_ptr<btCollisionShape> child, const btTransform& place) {
    compound.addChildShape(place, child.get());
    children.push_back(std::move(child));
  }
};

template <class BulletShape>
std::shared_ptr<btCollisionShape> with_margin(std::shared_ptr<BulletShape> shape, double margin) {
  shape->setMargin(static_cast<btScalar>(margin));
  return shape;
}

struct MakeShape {
  using Made = std::shared_ptr<btCollisionShape>;
  ConcaveContact concave;

  Made operator()(const SphereShape& s) const {
    return std::make_shared<btSphereShape>(static_cast<btScalar>(s.radius));
  }
  Made operator()(const BoxShape& s) const {
    return with_margin(std::make_shared<btBoxShape>(to_bullet(s.half_extents)),
                       kRoundingRatio * SmallestHalfExtent{}(s));
  }
  Made operator()(const PlaneShape&) const {
    return (*this)(BoxShape{{kPlaneHalfWidth, kPlaneHalfDepth, kPlaneHalfWidth}});
  }
  Made operator()(const CapsuleShape& s) const {
    return std::make_shared<btCapsuleShape>(static_cast<btScalar>(s.radius),
                                            static_cast<btScalar>(s.height));
  }
  Made operator()(const CylinderShape& s) const {
    const Vector3<double> half(s.radius, 0.5 * s.height, s.radius);
    return with_margin(std::make_shared<btCylinderShape>(to_bullet(half)),
                       kRoundingRatio * SmallestHalfExtent{}(s));
  }
  Made operator()(const ConeShape& s) const {
    return with_margin(std::make_shared<btConeShape>(static_cast<btScalar>(s.radius),
                                                     static_cast<btScalar>(s.height)),
                       kGrowthRatio * SmallestHalfExtent{}(s));
  }
  Made operator()(const ConvexHullShape& s) const {
    auto hull = std::make_shared<btConvexHullShape>();
    for (Eigen::Index i = 0; i < s.points.cols(); ++i) {
      hull->addPoint(to_bullet(s.points.col(i)), false);
    }
    hull->recalcLocalAabb();
    return with_margin(std::move(hull), kGrowthRatio * SmallestHalfExtent{}(s));
  }
  Made operator()(const MeshShape& s) const {
    return concave == ConcaveContact::kPrisms ? make_prisms(s) : make_triangle_mesh(s);
  }
  Made operator()(const HeightFieldShape& s) const {
    return concave == ConcaveContact::kPrisms ? make_prisms(s)
                                              : make_triangle_mesh(height_field_surface(s));
  }
  Made operator()(const CompoundShape& s) const {
    auto owned = std::make_shared<OwnedCompound>();
    for (const CompoundPart& part : s.parts) {
      owned->add(std::visit(*this, part.shape),
                 btTransform(in_bullet(part.orientation), to_bullet(part.position)));
    }
    return {owned, &owned->compound};
  }
};

/// The shape moved in its body's frame.
std::shared_ptr<btCollisionShape> moved(std::shared_ptr<btCollisionShape> shape,
                                        const Vector3<double>& by) {
  auto owned = std::make_shared<OwnedCompound>();
  owned->add(std::move(shape), btTransform(btQuaternion::getIdentity(), to_bullet(by)));
  return {owned, &owned->compound};
}

}  // namespace

Vector3<double> bullet_shape_offset(const Collider& collider) {
  if (std::holds_alternative<PlaneShape>(collider.shape)) return {0, -kPlaneHalfDepth, 0};
  if (collider.mass) return solid_moments(collider.shape).center;
  return Vector3<double>::Zero();
}

std::shared_ptr<btCollisionShape> make_bullet_shape(const Shape& shape, ConcaveContact concave) {
  return std::visit(MakeShape{concave}, shape);
}

BulletCollider make_bullet_collider(const Collider& collider, ConcaveContact concave) {
  BulletCollider result;
  result.shape = make_bullet_shape(collider.shape, concave);
  const Vector3<double> offset = bullet_shape_offset(collider);
  btVector3 inertia(0, 0, 0);
  if (collider.mass) {
    if (!offset.isZero(0)) result.shape = moved(std::move(result.shape), -offset);
    inertia = to_bullet(*collider.mass * solid_moments(collider.shape).inertia);
  }
  btRigidBody::btRigidBodyConstructionInfo info(static_cast<btScalar>(collider.mass.value_or(0.0)),
                                                nullptr, result.shape.get(), inertia);
  info.m_startWorldTransform =
      btTransform(in_bullet(collider.orientation),
                  to_bullet(collider.position + collider.orientation * offset));
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
  if (collider.path || !collider.led_by.empty()) {
    result.body->setCollisionFlags(result.body->getCollisionFlags() |
                                   btCollisionObject::CF_KINEMATIC_OBJECT);
  }
  result.body->setActivationState(DISABLE_DEACTIVATION);
  return result;
}

double distance_field_voxel(const Scene& scene) {
  double voxel = kLargestVoxel;
  for (const Collider& collider : scene.colliders) {
    voxel = std::min(voxel, std::visit(Voxel{}, collider.shape));
  }
  double finest = kSmallestVoxel;
  for (const Collider& collider : scene.colliders) {
    finest = std::max(finest, kSmallestVoxelRatio * std::visit(LargestExtent{}, collider.shape));
  }
  return std::max(voxel, finest);
}

double distance_field_reach(const Scene& scene) {
  return kMaxVoxels * distance_field_voxel(scene);
}

}  // namespace weft::scenes
