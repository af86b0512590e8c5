#include <weft/python/bindings/world/rigid_bodies.hpp>

#include <cmath>
#include <string_view>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include <weft/bridge/bullet/bullet_vector.hpp>
#include <weft/core/error.hpp>
#include <weft/engines/bullet/bullet_shapes.hpp>

namespace weft::python {
namespace {

using bridge::from_bullet;
using bridge::to_bullet;

/// Checks the numbers of a shape; `who` begins the messages.
struct CheckShape {
  std::string who;

  void positive(std::string_view name, double value) const {
    if (value > 0 && std::isfinite(value)) return;
    throw InvalidArgument(
        fmt::format("{}: {} = {} [m], expected > 0 and finite", who, name, value));
  }
  void operator()(const scenes::SphereShape& s) const { positive("radius", s.radius); }
  void operator()(const scenes::BoxShape& s) const {
    for (const double half : s.half_extents) positive("half_extents", half);
  }
  void operator()(const scenes::CapsuleShape& s) const {
    positive("radius", s.radius);
    positive("height", s.height);
  }
  void operator()(const scenes::CylinderShape& s) const {
    positive("radius", s.radius);
    positive("height", s.height);
  }
  void operator()(const scenes::ConeShape& s) const {
    positive("radius", s.radius);
    positive("height", s.height);
  }
  void operator()(const scenes::ConvexHullShape& s) const {
    const Eigen::Index n = s.points.cols();
    if (n < 4 || n > 128) {
      throw InvalidArgument(fmt::format("{}: {} points, expected 4 to 128", who, n));
    }
    const Matrix3X<double> spread = s.points.colwise() - s.points.rowwise().mean().eval();
    // The thinnest extent over the largest: of points in one plane it is rounding.
    const Vector3<double> extents =
        Eigen::JacobiSVD<Eigen::MatrixXd>(spread).singularValues().head<3>();
    if (!(extents[2] > 1e-9 * extents[0])) {
      throw InvalidArgument(who + ": all points lie in one plane, expected a solid");
    }
  }
  void operator()(const scenes::MeshShape& s) const {
    if (s.triangles.cols() == 0) throw InvalidArgument(who + ": no triangle, expected some");
  }
  template <class Other>
  void operator()(const Other& /*shape*/) const {}
};

bool is_concave(const scenes::Shape& shape) {
  return std::holds_alternative<scenes::PlaneShape>(shape) ||
         std::holds_alternative<scenes::MeshShape>(shape) ||
         std::holds_alternative<scenes::HeightFieldShape>(shape);
}

void check(const scenes::Shape& shape, const BodyOptions& options) {
  const std::string who = "body '" + options.name + "'";
  std::visit(CheckShape{who}, shape);
  const auto not_negative = [&](std::string_view name, double value, std::string_view unit) {
    if (value >= 0 && std::isfinite(value)) return;
    throw InvalidArgument(
        fmt::format("{}: {} = {} [{}], expected >= 0 and finite", who, name, value, unit));
  };
  not_negative("mass", options.mass, "kg");
  not_negative("friction", options.friction, "1");
  not_negative("restitution", options.restitution, "1");
  if (options.mass > 0 && options.is_kinematic) {
    throw InvalidArgument(
        fmt::format("{}: mass = {} [kg] of a kinematic body, expected 0: the program moves it", who,
                    options.mass));
  }
  if (options.mass > 0 && is_concave(shape)) {
    throw InvalidArgument(
        fmt::format("{}: mass = {} [kg], expected 0: planes and meshes are fixed or kinematic", who,
                    options.mass));
  }
}

/// Bullet's own plane, which has no end; Weft's contacts know it. That of scenes is a box of 40 m.
std::shared_ptr<btCollisionShape> make_plane() {
  return std::make_shared<btStaticPlaneShape>(btVector3(0, 1, 0), btScalar(0));
}

std::shared_ptr<BodyRecord> make_plane_body(const BodyOptions& options) {
  auto record = std::make_shared<BodyRecord>();
  record->shape = make_plane();
  record->body = std::make_unique<btRigidBody>(
      btRigidBody::btRigidBodyConstructionInfo(0, nullptr, record->shape.get()));
  record->body->setFriction(static_cast<btScalar>(options.friction));
  record->body->setActivationState(DISABLE_DEACTIVATION);
  return record;
}

}  // namespace

std::shared_ptr<BodyRecord> make_body(const scenes::Shape& shape, const BodyOptions& options) {
  check(shape, options);
  std::shared_ptr<BodyRecord> record;
  if (std::holds_alternative<scenes::PlaneShape>(shape)) {
    record = make_plane_body(options);
  } else {
    scenes::Collider collider{.name = options.name, .shape = shape};
    collider.friction = options.friction;
    if (options.mass > 0) collider.mass = options.mass;
    scenes::BulletCollider made =
        scenes::make_bullet_collider(collider, scenes::ConcaveContact::kPrisms);
    record = std::make_shared<BodyRecord>();
    record->shape = std::move(made.shape);
    record->body = std::move(made.body);
    record->offset = scenes::bullet_shape_offset(collider);
  }
  record->name = options.name;
  record->body->setRestitution(static_cast<btScalar>(options.restitution));
  if (options.is_kinematic) {
    record->body->setCollisionFlags(record->body->getCollisionFlags() |
                                    btCollisionObject::CF_KINEMATIC_OBJECT);
  }
  place(*record, options.position, options.orientation);
  record->body->setInterpolationWorldTransform(record->body->getWorldTransform());
  return record;
}

Eigen::Quaterniond orientation_of(const BodyRecord& body) {
  const btQuaternion q = body.body->getWorldTransform().getRotation();
  return {static_cast<double>(q.w()), static_cast<double>(q.x()), static_cast<double>(q.y()),
          static_cast<double>(q.z())};
}

Vector3<double> position_of(const BodyRecord& body) {
  const Vector3<double> origin = from_bullet(body.body->getWorldTransform().getOrigin());
  if (body.offset.isZero(0)) return origin;
  return origin - orientation_of(body) * body.offset;
}

void place(BodyRecord& body, const Vector3<double>& position,
           const Eigen::Quaterniond& orientation) {
  const Eigen::Quaternion<btScalar> q = orientation.cast<btScalar>();
  body.body->setWorldTransform(btTransform(btQuaternion(q.x(), q.y(), q.z(), q.w()),
                                           to_bullet(position + orientation * body.offset)));
  body.body->activate(true);
}

}  // namespace weft::python
