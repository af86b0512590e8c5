#include <weft/validation/metrics/distance/point_triangle.hpp>

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace weft::validation {

double point_segment_distance(const Vector3<double>& point, const Vector3<double>& p,
                              const Vector3<double>& q) {
  const Vector3<double> along = q - p;
  const double squared_length = along.squaredNorm();
  const Vector3<double> from_p = point - p;
  if (squared_length == 0) return from_p.norm();
  const double t = std::clamp(from_p.dot(along) / squared_length, 0.0, 1.0);
  return (from_p - t * along).norm();
}

double point_triangle_distance(const Vector3<double>& point, const Triangle& triangle) {
  const auto& [a, b, c] = triangle;
  const Vector3<double> ab = b - a;
  const Vector3<double> bc = c - b;
  const Vector3<double> ca = a - c;
  const Vector3<double> normal = ab.cross(bc);
  const double twice_area = normal.norm();
  const double longest = std::max({ab.squaredNorm(), bc.squaredNorm(), ca.squaredNorm()});
  if (twice_area > kFlatnessRatio * longest) {
    const bool above_interior = ab.cross(point - a).dot(normal) >= 0 &&
                                bc.cross(point - b).dot(normal) >= 0 &&
                                ca.cross(point - c).dot(normal) >= 0;
    if (above_interior) return std::abs((point - a).dot(normal)) / twice_area;
  }
  return std::min({point_segment_distance(point, a, b), point_segment_distance(point, b, c),
                   point_segment_distance(point, c, a)});
}

}  // namespace weft::validation
