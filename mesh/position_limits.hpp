#pragma once

#include <weft/core/types.hpp>

namespace weft {

/// How far the nodes of a cloth may be from where an animation has them, as character artists set it:
/// no further than a maximum distance, and outside a ball behind the animated place, the backstop,
/// which stands for the body there.
struct PositionLimits {
  Matrix3X<double> centers;        ///< 3 x n [m], the animated places; 3 x 0: no limits
  VectorX<double> max_distances;   ///< n [m], >= 0; infinity: no limit for this node
  Matrix3X<double> normals;        ///< 3 x n [-], unit, of the animated surface; 3 x 0: no backstop
  VectorX<double> backstop_radii;  ///< n [m], >= 0; 0: no backstop for this node
  /// How far behind the animated place the ball begins, n [m], >= 0: the middle of the ball is
  /// offset + radius behind it, against the normal.
  VectorX<double> backstop_offsets;

  [[nodiscard]] bool is_empty() const { return centers.cols() == 0; }
};

/// Throws InvalidArgument unless limits are empty or fit num_nodes nodes and are in their domain.
void check_position_limits(const PositionLimits& limits, int num_nodes);

/// The allowed place that a node at position is moved to [m]: position itself if it is allowed.
/// Otherwise the nearest place of the limit that is violated; where that violates the other one, the
/// nearest place of the circle in which the sphere of the maximum distance meets the backstop's. A
/// closed form: both limits hold afterwards to rounding.
[[nodiscard]] Vector3<double> limited_position(const PositionLimits& limits, int node,
                                               const Vector3<double>& position);

}  // namespace weft
