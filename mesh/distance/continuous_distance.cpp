#include <weft/mesh/distance/continuous_distance.hpp>

#include <algorithm>
#include <cmath>

namespace weft {

Nearest nearest(PairKind kind, const FourPoints& points) {
  return kind == PairKind::kPointTriangle ? nearest_point_triangle(points) : nearest_edges(points);
}

std::optional<double> first_approach(PairKind kind, const FourPoints& start,
                                     const FourPoints& motion, double distance,
                                     std::int64_t* num_distances) {
  // Common motion changes no distance; without it the bound is tighter.
  const FourPoints own = motion.colwise() - motion.rowwise().mean();
  const int split = kind == PairKind::kPointTriangle ? 1 : 2;
  double reach[2] = {0.0, 0.0};
  for (int k = 0; k < 4; ++k) {
    double& longest = reach[k < split ? 0 : 1];
    longest = std::max(longest, own.col(k).norm());
  }
  const double speed = reach[0] + reach[1];
  constexpr int kMaxAdvances = 2000;  // a pair that creeps along at this distance counts as near
  double part = 0.0;
  for (int advance = 0; advance < kMaxAdvances; ++advance) {
    if (num_distances) ++*num_distances;
    const double now = nearest(kind, start + part * motion).distance();
    if (!(now > distance)) return part;
    if (!(speed > 0.0)) return std::nullopt;
    part += (now - 0.9 * distance) / speed;
    if (part >= 1.0) return std::nullopt;
  }
  return part;
}

}  // namespace weft
