#include <weft/bridge/contact/surface/surface_distance.hpp>

#include <algorithm>
#include <cmath>

#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/CollisionShapes/btCapsuleShape.h>
#include <BulletCollision/CollisionShapes/btConeShape.h>
#include <BulletCollision/CollisionShapes/btCylinderShape.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {
namespace {

using Point = Vector3<double>;
using Profile = Eigen::Vector2d;  ///< distance from the axis, height along it

struct ProfileDistance {
  double distance;  ///< [m]
  Profile out;      ///< unit vector
};

SurfaceDistance of_ball(double radius, const Point& point) {
  const double length = point.norm();
  return {length - radius, length > 0 ? Point(point / length) : Point(0, 1, 0)};
}

SurfaceDistance of_box(const Point& half, const Point& point) {
  const Point beyond = point.cwiseAbs() - half;
  Eigen::Index axis = 0;
  const double deepest = beyond.maxCoeff(&axis);
  Point out = Point::Zero();
  if (deepest <= 0) {
    out[axis] = point[axis] < 0 ? -1 : 1;
    return {deepest, out};
  }
  for (int k = 0; k < 3; ++k) {
    if (beyond[k] > 0) out[k] = point[k] < 0 ? -beyond[k] : beyond[k];
  }
  const double distance = out.norm();
  return {distance, out / distance};
}

/// A solid of revolution about an axis, from its profile's distance.
template <class OfProfile>
SurfaceDistance of_revolution(int axis, const Point& point, const OfProfile& of_profile) {
  Point across = point;
  across[axis] = 0;
  const double radius = across.norm();
  const ProfileDistance found = of_profile(Profile(radius, point[axis]));
  if (radius > 0) {
    across /= radius;
  } else {
    across[(axis + 1) % 3] = 1;  // on the axis all directions are as near
  }
  Point out = found.out[0] * across;
  out[axis] = found.out[1];
  return {found.distance, out};
}

ProfileDistance of_capsule(double radius, double half_height, const Profile& point) {
  const Profile away(point[0], point[1] - std::clamp(point[1], -half_height, half_height));
  const double length = away.norm();
  return {length - radius, length > 0 ? Profile(away / length) : Profile(1, 0)};
}

ProfileDistance of_cylinder(double radius, double half_height, const Profile& point) {
  const double side = point[1] < 0 ? -1 : 1;
  const Profile beyond(point[0] - radius, std::abs(point[1]) - half_height);
  if (beyond[0] <= 0 || beyond[1] <= 0) {
    if (beyond[0] > beyond[1]) return {beyond[0], {1, 0}};
    return {beyond[1], {0, side}};
  }
  const double distance = beyond.norm();
  return {distance, Profile(beyond[0], side * beyond[1]) / distance};
}

/// The tip is at half_height, the base at -half_height.
ProfileDistance of_cone(double radius, double half_height, const Profile& point) {
  const Profile tip(0, half_height);
  const Profile rim(radius, -half_height);
  const Profile along = rim - tip;
  const Profile normal = Profile(-along[1], along[0]).normalized();
  const double over_side = normal.dot(point - tip);
  const double under_base = -half_height - point[1];
  if (over_side <= 0 && under_base <= 0) {
    if (over_side > under_base) return {over_side, normal};
    return {under_base, {0, -1}};
  }
  if (under_base > 0 && point[0] <= radius) return {under_base, {0, -1}};
  const double share = std::clamp((point - tip).dot(along) / along.squaredNorm(), 0.0, 1.0);
  if (over_side > 0 && share > 0 && share < 1) return {over_side, normal};
  const Profile away = point - (tip + share * along);
  const double distance = away.norm();
  return {distance, distance > 0 ? Profile(away / distance) : normal};
}

SurfaceDistance grown(SurfaceDistance found, btScalar margin) {
  found.distance -= static_cast<double>(margin);
  return found;
}

SurfaceDistance of(const btCapsuleShape& shape, const Point& point) {
  // Bullet keeps the signs of a scaling here, and here only.
  const auto radius = std::abs(static_cast<double>(shape.getRadius()));
  const auto half_height = std::abs(static_cast<double>(shape.getHalfHeight()));
  return of_revolution(shape.getUpAxis(), point,
                       [&](const Profile& p) { return of_capsule(radius, half_height, p); });
}

SurfaceDistance of(const btCylinderShape& shape, const Point& point) {
  const int axis = shape.getUpAxis();
  const auto radius = static_cast<double>(shape.getRadius());
  const auto half_height = static_cast<double>(shape.getHalfExtentsWithMargin()[axis]);
  return of_revolution(axis, point,
                       [&](const Profile& p) { return of_cylinder(radius, half_height, p); });
}

SurfaceDistance of(const btConeShape& shape, const Point& point) {
  const auto radius = static_cast<double>(shape.getRadius());
  const double half_height = static_cast<double>(shape.getHeight()) / 2;
  return grown(of_revolution(shape.getConeUpIndex(), point,
                             [&](const Profile& p) { return of_cone(radius, half_height, p); }),
               shape.getMargin());
}

}  // namespace

std::optional<SurfaceDistance> surface_distance(const btCollisionShape& shape,
                                                const HullFacets* facets, const Point& point,
                                                double reach) {
  switch (shape.getShapeType()) {
    case SPHERE_SHAPE_PROXYTYPE:
      return of_ball(static_cast<double>(static_cast<const btSphereShape&>(shape).getRadius()),
                     point);
    case BOX_SHAPE_PROXYTYPE: {
      const btVector3 half = static_cast<const btBoxShape&>(shape).getHalfExtentsWithMargin();
      return of_box(Point(static_cast<double>(half.x()), static_cast<double>(half.y()),
                          static_cast<double>(half.z())),
                    point);
    }
    case CAPSULE_SHAPE_PROXYTYPE:
      return of(static_cast<const btCapsuleShape&>(shape), point);
    case CYLINDER_SHAPE_PROXYTYPE:
      return of(static_cast<const btCylinderShape&>(shape), point);
    case CONE_SHAPE_PROXYTYPE:
      return of(static_cast<const btConeShape&>(shape), point);
    default:
      if (facets == nullptr) return std::nullopt;
      return grown(facets->distance(point, reach + static_cast<double>(shape.getMargin())),
                   shape.getMargin());
  }
}

bool needs_distance_field(const btCollisionShape& shape, const HullFacets* facets) {
  return !surface_distance(shape, facets, Point::Zero(), 0);
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
