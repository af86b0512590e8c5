#include <weft/recorder/placed_shape.hpp>

#include <optional>
#include <utility>

#include <btBulletCollisionCommon.h>
#include <fmt/format.h>

#include <weft/bridge/bullet/bullet_vector.hpp>
#include <weft/core/error.hpp>

namespace weft::recorder {
inline namespace WEFT_BULLET_PRECISION {
namespace {

using bridge::from_bullet;

/// Turns the y axis into another one; exactly nothing for the y axis itself.
Eigen::Quaterniond from_y_to(const Vector3<double>& axis) {
  return Eigen::Quaterniond::FromTwoVectors(Vector3<double>::UnitY(), axis);
}

scenes::CompoundPart along(int axis, const scenes::ConvexShape& shape) {
  return {shape, Vector3<double>::Zero(), from_y_to(Vector3<double>::Unit(axis))};
}

scenes::CompoundPart part_of(const btCapsuleShape& capsule) {
  const double height = 2 * static_cast<double>(capsule.getHalfHeight());
  const auto radius = static_cast<double>(capsule.getRadius());
  return along(capsule.getUpAxis(), scenes::CapsuleShape{radius, height});
}

scenes::CompoundPart part_of(const btCylinderShape& cylinder) {
  const int axis = cylinder.getUpAxis();
  const double height = 2 * static_cast<double>(cylinder.getHalfExtentsWithMargin()[axis]);
  const auto radius = static_cast<double>(cylinder.getRadius());
  return along(axis, scenes::CylinderShape{radius, height});
}

scenes::CompoundPart part_of(const btConeShape& cone) {
  return along(cone.getConeUpIndex(), scenes::ConeShape{static_cast<double>(cone.getRadius()),
                                                        static_cast<double>(cone.getHeight())});
}

scenes::CompoundPart part_of(const btConvexHullShape& hull) {
  scenes::ConvexHullShape points{Matrix3X<double>(3, hull.getNumPoints())};
  for (int i = 0; i < hull.getNumPoints(); ++i) {
    points.points.col(i) = from_bullet(hull.getScaledPoint(i));
  }
  return {std::move(points)};
}

std::optional<scenes::CompoundPart> convex_part(const btCollisionShape& shape) {
  switch (shape.getShapeType()) {
    case SPHERE_SHAPE_PROXYTYPE: {
      const auto& sphere = static_cast<const btSphereShape&>(shape);
      return scenes::CompoundPart{scenes::SphereShape{static_cast<double>(sphere.getRadius())}};
    }
    case BOX_SHAPE_PROXYTYPE: {
      const auto& box = static_cast<const btBoxShape&>(shape);
      return scenes::CompoundPart{scenes::BoxShape{from_bullet(box.getHalfExtentsWithMargin())}};
    }
    case CAPSULE_SHAPE_PROXYTYPE:
      return part_of(static_cast<const btCapsuleShape&>(shape));
    case CYLINDER_SHAPE_PROXYTYPE:
      return part_of(static_cast<const btCylinderShape&>(shape));
    case CONE_SHAPE_PROXYTYPE:
      return part_of(static_cast<const btConeShape&>(shape));
    case CONVEX_HULL_SHAPE_PROXYTYPE:
      return part_of(static_cast<const btConvexHullShape&>(shape));
    default:
      return std::nullopt;
  }
}

PlacedShape placed_plane(const btStaticPlaneShape& plane) {
  const Vector3<double> normal = from_bullet(plane.getPlaneNormal());
  const auto constant = static_cast<double>(plane.getPlaneConstant());
  return {scenes::PlaneShape{}, constant * normal, from_y_to(normal)};
}

/// Compounds may hold compounds; a scene's hold convex shapes only.
void add_parts(const btCompoundShape& compound, const btTransform& place, const std::string& body,
               scenes::CompoundShape& out) {
  for (int i = 0; i < compound.getNumChildShapes(); ++i) {
    const btCollisionShape& child = *compound.getChildShape(i);
    const btTransform child_place = place * compound.getChildTransform(i);
    if (child.isCompound()) {
      add_parts(static_cast<const btCompoundShape&>(child), child_place, body, out);
      continue;
    }
    std::optional<scenes::CompoundPart> part = convex_part(child);
    if (!part) {
      throw InvalidArgument(fmt::format(
          "{}: part {} of its compound is a {}, expected a sphere, box, capsule, cylinder, cone or "
          "convex hull",
          body, i, child.getName()));
    }
    const btQuaternion turn = child_place.getRotation();
    const Eigen::Quaterniond orientation(
        static_cast<double>(turn.w()), static_cast<double>(turn.x()), static_cast<double>(turn.y()),
        static_cast<double>(turn.z()));
    part->position = from_bullet(child_place.getOrigin());
    part->orientation = (orientation * part->orientation).normalized();
    out.parts.push_back(std::move(*part));
  }
}

}  // namespace

PlacedShape placed_shape(const btCollisionShape& shape, const std::string& body) {
  if (std::optional<scenes::CompoundPart> part = convex_part(shape)) {
    return {scenes::as_shape(part->shape), part->position, part->orientation};
  }
  if (shape.getShapeType() == STATIC_PLANE_PROXYTYPE) {
    return placed_plane(static_cast<const btStaticPlaneShape&>(shape));
  }
  if (shape.getShapeType() == COMPOUND_SHAPE_PROXYTYPE) {
    scenes::CompoundShape compound;
    add_parts(static_cast<const btCompoundShape&>(shape), btTransform::getIdentity(), body,
              compound);
    return {std::move(compound)};
  }
  throw InvalidArgument(fmt::format(
      "{}: its shape is a {}, expected a sphere, box, capsule, cylinder, cone, convex hull, static "
      "plane, or a compound of these without planes",
      body, shape.getName()));
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::recorder
