#include <weft/mesh/embedding/bound_point.hpp>

namespace weft {

BoundPoint bind_point(const Vector3<double>& point, const SurfacePoint& place,
                      const Matrix3<double>& corners, const Matrix3<double>& normals) {
  BoundPoint bound;
  bound.triangle = place.triangle;
  bound.weights = place.weights;
  const Vector3<double> base = corners * place.weights;
  bound.normal = unit_or_zero(normals * place.weights);
  bound.height = bound.normal.dot(point - base);
  const Vector3<double> beside = point - base - bound.height * bound.normal;
  for (int i = 0; i < 3; ++i) {
    bound.arms.col(i) = place.weights[i] * (0.5 * (base - corners.col(i)) + beside);
  }
  return bound;
}

}  // namespace weft
