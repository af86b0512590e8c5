#pragma once

// Tested by tests/reference/self_contact_test.cpp.

#include <array>

#include <weft/core/types.hpp>

namespace weft {

/// Where two primitives of a cloth are nearest to each other. Points are four columns: a point and a
/// triangle, or two edges. The separation is the weighted sum of the four points.
struct Nearest {
  std::array<double, 4> weights{};      ///< [-]; they sum up to 0
  Vector3<double> separation{0, 0, 0};  ///< [m], from the second primitive to the first
  [[nodiscard]] double distance() const { return separation.norm(); }
};

using FourPoints = Eigen::Matrix<double, 3, 4>;

/// Barycentric weights of the point of a triangle (columns) that is nearest to a point [-].
[[nodiscard]] Vector3<double> nearest_on_triangle(const Vector3<double>& point,
                                                  const Matrix3<double>& triangle);

/// Column 0 against the triangle of columns 1 to 3.
[[nodiscard]] Nearest nearest_point_triangle(const FourPoints& points);

/// The edge of columns 0 and 1 against that of columns 2 and 3.
[[nodiscard]] Nearest nearest_edges(const FourPoints& points);

}  // namespace weft
