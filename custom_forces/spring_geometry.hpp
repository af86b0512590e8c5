#pragma once

#include <cmath>

#include <weft/custom_forces/core/types.hpp>

namespace weft::forces {

/// Shortest spring whose direction is still trusted, as a fraction of its rest length [-]. At 1e-6
/// the direction of a double-precision spring has a relative error of about 2e-10, far below every
/// validated tolerance; a shorter spring exerts no force, for a direction made of rounding errors
/// would be noise.
inline constexpr double kMinLengthRatio = 1e-6;

/// Direction and length of one edge.
template <class Scalar>
struct SpringGeometry {
  Vector3<Scalar>
      direction;  ///< unit vector from the first to the second node; zero if the edge is too short
  Scalar length;  ///< [m]
  bool has_direction;
};

template <class Scalar>
[[nodiscard]] SpringGeometry<Scalar> spring_geometry(const Vector3<Scalar>& first,
                                                     const Vector3<Scalar>& second,
                                                     Scalar rest_length) {
  using std::sqrt;
  const Vector3<Scalar> difference = second - first;
  const Scalar squared_length = difference.squaredNorm();
  const Scalar shortest = Scalar(kMinLengthRatio) * rest_length;
  if (!(squared_length > shortest * shortest)) {
    return {Vector3<Scalar>::Zero(), Scalar(0), false};
  }
  const Scalar length = sqrt(squared_length);
  return {Vector3<Scalar>(difference / length), length, true};
}

}  // namespace weft::forces
