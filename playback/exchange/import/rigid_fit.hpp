#pragma once

#include <weft/core/types.hpp>
#include <weft/scenes/motion/pose.hpp>

namespace weft::scenes {

/// The place and orientation of a rigid body that put its own points nearest to where they were found.
struct RigidFit {
  Pose pose;
  double largest_residual =
      0.0;  ///< [m] of a point from where the body has it; not small: the points are no rigid body's
};

/// Least squares over all points, never a reflection (Umeyama 1991, without scale).
/// Shapes   own, found 3 x n [m], n >= 3 and not all on one line
[[nodiscard]] RigidFit fit_rigid(const Matrix3X<double>& own, const Matrix3X<double>& found);

}  // namespace weft::scenes
