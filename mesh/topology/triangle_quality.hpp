#pragma once

#include <weft/core/types.hpp>

namespace weft {

/// How well the triangles of a surface are shaped, over all of them. Of no triangle: every length 0, the angle that of an
/// equilateral one, the triangle -1.
struct TriangleQuality {
  double smallest_angle = 1.0471975511965976;  ///< [rad]
  int sharpest = -1;                           ///< the triangle that has it, the first of several
  int num_sharp = 0;         ///< triangles with an angle below the limit that was asked for
  double shortest_edge = 0;  ///< [m]
  double longest_edge = 0;   ///< [m]
  /// [m] The largest radius of a ball that can stand in the middle of a triangle without a node inside it: the circumradius, or
  /// half of the longest edge of an obtuse triangle, whose circumcenter lies outside.
  double largest_gap = 0;
};

/// positions: 3 x n [m]; triangles: 3 x t. sharp: [rad]. A triangle without an area has an angle of 0.
[[nodiscard]] TriangleQuality triangle_quality(ConstMatrix3XRef<double> positions,
                                               const Triangles& triangles, double sharp);

}  // namespace weft
