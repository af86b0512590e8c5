#include <weft/validation/metrics/signed_distance.hpp>

#include <algorithm>
#include <limits>
#include <variant>

namespace weft::validation {
namespace {

double local_distance(const scenes::SphereShape& sphere, const Vector3<double>& point) {
  return point.norm() - sphere.radius;
}

double local_distance(const scenes::BoxShape& box, const Vector3<double>& point) {
  const Vector3<double> beyond = point.cwiseAbs() - box.half_extents;
  return beyond.cwiseMax(0.0).norm() + std::min(beyond.maxCoeff(), 0.0);
}

double local_distance(const scenes::PlaneShape&, const Vector3<double>& point) {
  return point.y();
}

}  // namespace

double signed_distance(const scenes::Shape& shape, const Pose& pose, const Vector3<double>& point) {
  // Checked here because cwiseMax and min may drop a NaN.
  const bool finite = point.allFinite() && pose.position.allFinite() &&
                      pose.orientation.coeffs().allFinite() && pose.orientation.norm() > 0;
  if (!finite) return std::numeric_limits<double>::quiet_NaN();
  const Vector3<double> local =
      pose.orientation.normalized().conjugate() * Vector3<double>(point - pose.position);
  return std::visit([&](const auto& s) { return local_distance(s, local); }, shape);
}

}  // namespace weft::validation
