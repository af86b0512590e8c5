#include <weft/mesh/topology/triangle_quality.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace weft {
namespace {

/// The angle opposite to the first length. Two edges of no length make none.
double angle_opposite(double a, double b, double c) {
  if (!(b > 0) || !(c > 0)) return 0;
  const double cosine = (b * b + c * c - a * a) / (2 * b * c);
  return std::acos(std::clamp(cosine, -1.0, 1.0));
}

}  // namespace

TriangleQuality triangle_quality(ConstMatrix3XRef<double> positions, const Triangles& triangles,
                                 double sharp) {
  TriangleQuality quality;
  for (Eigen::Index t = 0; t < triangles.cols(); ++t) {
    std::array<double, 3> edges{};
    for (int corner = 0; corner < 3; ++corner) {
      edges[static_cast<std::size_t>(corner)] =
          (positions.col(triangles(corner, t)) - positions.col(triangles((corner + 1) % 3, t)))
              .norm();
    }
    std::sort(edges.begin(), edges.end());
    const double angle = angle_opposite(edges[0], edges[1], edges[2]);
    const double widest = angle_opposite(edges[2], edges[0], edges[1]);
    const bool is_obtuse = !(std::cos(widest) > 0);
    const double gap = is_obtuse ? edges[2] / 2 : edges[2] / (2 * std::sin(widest));
    if (quality.sharpest < 0 || angle < quality.smallest_angle) {
      quality.smallest_angle = angle;
      quality.sharpest = static_cast<int>(t);
    }
    if (angle < sharp) ++quality.num_sharp;
    quality.shortest_edge = t == 0 ? edges[0] : std::min(quality.shortest_edge, edges[0]);
    quality.longest_edge = std::max(quality.longest_edge, edges[2]);
    quality.largest_gap = std::max(quality.largest_gap, gap);
  }
  return quality;
}

}  // namespace weft
