#include <weft/validation/reference/contact/signed_distance.hpp>

#include <cmath>

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
