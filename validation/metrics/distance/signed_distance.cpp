#include <weft/validation/metrics/distance/signed_distance.hpp>

#include <limits>

namespace weft::validation {

double signed_distance(const ShapeDistance& shape, const Pose& pose, const Vector3<double>& point) {
  // Checked here because closed forms may drop a NaN.
  const bool finite = point.allFinite() && pose.position.allFinite() &&
                      pose.orientation.coeffs().allFinite() && pose.orientation.norm() > 0;
  if (!finite) return std::numeric_limits<double>::quiet_NaN();
  const Vector3<double> local =
      pose.orientation.normalized().conjugate() * Vector3<double>(point - pose.position);
  return shape(local);
}

double signed_distance(const scenes::Shape& shape, const Pose& pose, const Vector3<double>& point) {
  return signed_distance(ShapeDistance(shape), pose, point);
}

}  // namespace weft::validation
