#pragma once

// Tested by tests/validation/metrics/distance/surface_distance_test.cpp.

#include <weft/core/types.hpp>

namespace weft::validation {

/// A triangle in space, corners in any order [m]. It may be a segment or a point.
struct Triangle {
  Vector3<double> a;
  Vector3<double> b;
  Vector3<double> c;
};

/// Distance from a point to the nearest point of the segment p q [m]; p = q is allowed.
[[nodiscard]] double point_segment_distance(const Vector3<double>& point, const Vector3<double>& p,
                                            const Vector3<double>& q);

/// Distance from a point to the nearest point of a triangle, interior and edges [m]. Exact but for
/// rounding; for a needle thinner than kFlatnessRatio of its length, to its edges.
[[nodiscard]] double point_triangle_distance(const Vector3<double>& point,
                                             const Triangle& triangle);

/// Height over longest edge below which a triangle counts as a segment [-]. 1e-8 = sqrt(eps): the
/// normal of a thinner triangle is wrong by more than 1e-8, while leaving its interior out costs
/// less than 1e-8 of its length.
inline constexpr double kFlatnessRatio = 1e-8;

}  // namespace weft::validation
