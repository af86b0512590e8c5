#include <weft/validation/metrics/distance/surface_distance.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <weft/core/error.hpp>
#include <weft/validation/metrics/distance/surface_index.hpp>
#include <weft/validation/metrics/series/percentile.hpp>

namespace weft::validation {
namespace {

OneSidedDistance summary(const VectorX<double>& distances) {
  OneSidedDistance result;
  result.mean = distances.mean();
  result.percentile_95 = percentile(distances, 95.0);
  for (Eigen::Index i = 0; i < distances.size(); ++i) {
    if (std::isnan(distances[i])) {
      result.largest = distances[i];
      result.largest_node = static_cast<int>(i);
      break;
    }
    if (distances[i] > result.largest) {
      result.largest = distances[i];
      result.largest_node = static_cast<int>(i);
    }
  }
  return result;
}

/// std::max returns its first argument when the second is NaN; here NaN wins.
double larger(double a, double b) {
  return std::isnan(a) || std::isnan(b) ? std::numeric_limits<double>::quiet_NaN() : std::max(a, b);
}

}  // namespace

VectorX<double> distances_to_surface(ConstMatrix3XRef<double> points, const Surface& surface) {
  if (points.cols() == 0) {
    throw InvalidArgument("surface distance: points = 0, expected >= 1");
  }
  const SurfaceIndex index(surface.positions, surface.triangles);
  VectorX<double> distances(points.cols());
  for (Eigen::Index i = 0; i < points.cols(); ++i) distances[i] = index.distance(points.col(i));
  return distances;
}

SurfaceDistance surface_distance(const Surface& a, const Surface& b) {
  SurfaceDistance result;
  result.a_to_b = summary(distances_to_surface(a.positions, b));
  result.b_to_a = summary(distances_to_surface(b.positions, a));
  result.hausdorff = larger(result.a_to_b.largest, result.b_to_a.largest);
  result.hausdorff_95 = larger(result.a_to_b.percentile_95, result.b_to_a.percentile_95);
  result.chamfer = 0.5 * (result.a_to_b.mean + result.b_to_a.mean);
  return result;
}

}  // namespace weft::validation
