#include <weft/reference/contact/distance/deepest_point.hpp>

#include <weft/mesh/distance/primitive_distance.hpp>

namespace weft::reference {

Vector3<double> deepest_point(const Shape& shape, const Pose& pose,
                              const Matrix3<double>& triangle) {
  if (std::holds_alternative<Sphere>(shape)) return nearest_on_triangle(pose.position, triangle);
  const auto distance = [&](const Vector3<double>& weights) {
    return signed_distance(shape, pose, triangle * weights).distance;
  };
  Vector3<double> best = Vector3<double>::Constant(1.0 / 3.0);
  double least = distance(best);
  const auto try_weights = [&](const Vector3<double>& weights) {
    const double found = distance(weights);
    if (!(found < least)) return false;
    least = found;
    best = weights;
    return true;
  };
  for (int k = 0; k < 3; ++k) (void)try_weights(Vector3<double>::Unit(k));
  double step = 0.5;
  while (step > kCompassStep) {
    bool moved = false;
    for (int from = 0; from < 3; ++from) {
      for (int to = 0; to < 3; ++to) {
        // Half way between the corners' directions too, for a crease between two of them.
        for (const double part : {1.0, 0.5}) {
          if (from == to) continue;
          Vector3<double> weights = best;
          const double shift = std::min(step, weights[from]);
          weights[from] -= shift;
          weights[to] += part * shift;
          weights[3 - from - to] += (1.0 - part) * shift;
          moved |= shift > 0.0 && try_weights(weights);
        }
      }
    }
    if (!moved) step *= 0.5;
  }
  return best;
}

}  // namespace weft::reference
