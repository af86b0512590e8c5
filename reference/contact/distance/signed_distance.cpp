#include <weft/reference/contact/distance/signed_distance.hpp>

#include <algorithm>
#include <cmath>

#include <weft/reference/contact/distance/mesh_surface.hpp>

namespace weft::reference {
namespace {

SurfaceDistance distance_body(const Sphere& sphere, const Vector3<double>& point) {
  const double radius = point.norm();
  if (!(radius > 0.0)) return {-sphere.radius, Vector3<double>::UnitX()};
  return {radius - sphere.radius, point / radius};
}

SurfaceDistance distance_body(const Plane& /*plane*/, const Vector3<double>& point) {
  return {point.y(), Vector3<double>::UnitY()};
}

SurfaceDistance distance_body(const Box& box, const Vector3<double>& point) {
  const Vector3<double> beyond = point.cwiseAbs() - box.half_extents;  // per axis, > 0 outside
  const auto outward = [&](int axis) { return std::signbit(point[axis]) ? -1.0 : 1.0; };
  Vector3<double> normal = Vector3<double>::Zero();
  int nearest_face = 0;
  const double largest = beyond.maxCoeff(&nearest_face);
  if (largest <= 0.0) {
    normal[nearest_face] = outward(nearest_face);
    return {largest, normal};
  }
  // Outside: the nearest point is on a face, an edge or a corner, as one, two or three axes are
  // beyond.
  for (int axis = 0; axis < 3; ++axis) {
    if (beyond[axis] > 0.0) normal[axis] = beyond[axis] * outward(axis);
  }
  // Scaled by the largest part, so that a distance near the smallest number has a unit normal too.
  normal /= largest;
  const double length = normal.norm();
  return {largest * length, normal / length};
}

/// Distance of a point in a half plane through the axis, and its gradient there.
struct ProfileDistance {
  double distance;
  double radial, axial;  // unit gradient
};

/// The distance from a solid of revolution about y.
template <class Profile>
SurfaceDistance revolved(const Vector3<double>& point, const Profile& profile) {
  const double radius = std::hypot(point.x(), point.z());
  const ProfileDistance found = profile(radius, point.y());
  const Vector3<double> outward = radius > 0.0
                                      ? Vector3<double>(point.x() / radius, 0, point.z() / radius)
                                      : Vector3<double>::UnitX();
  return {found.distance, found.radial * outward + found.axial * Vector3<double>::UnitY()};
}

SurfaceDistance distance_body(const Capsule& capsule, const Vector3<double>& point) {
  const double half = 0.5 * capsule.height;
  const Vector3<double> centre(0, std::clamp(point.y(), -half, half), 0);
  return distance_body(Sphere{capsule.radius}, point - centre);
}

SurfaceDistance distance_body(const Cylinder& cylinder, const Vector3<double>& point) {
  return revolved(point, [&](double r, double y) -> ProfileDistance {
    const double beyond_side = r - cylinder.radius;
    const double beyond_end = std::abs(y) - 0.5 * cylinder.height;
    const double up = std::signbit(y) ? -1.0 : 1.0;
    if (beyond_side <= 0.0 || beyond_end <= 0.0) {
      return beyond_side > beyond_end ? ProfileDistance{beyond_side, 1, 0}
                                      : ProfileDistance{beyond_end, 0, up};
    }
    const double distance = std::hypot(beyond_side, beyond_end);
    return {distance, beyond_side / distance, up * beyond_end / distance};
  });
}

SurfaceDistance distance_body(const Cone& cone, const Vector3<double>& point) {
  return revolved(point, [&](double r, double y) -> ProfileDistance {
    const double slant = std::hypot(cone.radius, cone.height);
    const double normal_r = cone.height / slant, normal_y = cone.radius / slant;
    const double top = 0.5 * cone.height;
    const double beyond_side = normal_r * r + normal_y * (y - top);  // of the slanted line
    const double beyond_base = -top - y;
    if (beyond_side <= 0.0 && beyond_base <= 0.0) {
      return beyond_side > beyond_base ? ProfileDistance{beyond_side, normal_r, normal_y}
                                       : ProfileDistance{beyond_base, 0, -1};
    }
    // Outside: the nearest point is on the base or on the slanted line, between their ends.
    const double along = std::clamp((normal_y * r - normal_r * (y - top)) / slant, 0.0, 1.0);
    const double side_r = along * cone.radius, side_y = top - along * cone.height;
    const double base_r = std::min(r, cone.radius);
    const double to_side = std::hypot(r - side_r, y - side_y);
    const double to_base = std::hypot(r - base_r, y + top);
    if (to_base < to_side) return {to_base, (r - base_r) / to_base, (y + top) / to_base};
    return {to_side, (r - side_r) / to_side, (y - side_y) / to_side};
  });
}

SurfaceDistance distance_body(const Mesh& mesh, const Vector3<double>& point) {
  return mesh.surface->distance(point);
}

}  // namespace

SurfaceDistance signed_distance(const Shape& shape, const Pose& pose,
                                const Vector3<double>& point) {
  const Vector3<double> point_body = pose.orientation.conjugate() * (point - pose.position);
  SurfaceDistance result =
      std::visit([&](const auto& one) { return distance_body(one, point_body); }, shape);
  result.normal = pose.orientation * result.normal;
  return result;
}

}  // namespace weft::reference
