#pragma once

#include <weft/core/types.hpp>

namespace weft::validation {

/// A triangle surface as it is now.
struct Surface {
  Matrix3X<double> positions;  ///< 3 x n [m]
  Triangles triangles;         ///< 3 x t, t >= 1
};

/// Distances from the nodes of one surface to another surface.
struct OneSidedDistance {
  double largest = 0.0;        ///< [m]
  double percentile_95 = 0.0;  ///< [m]
  double mean = 0.0;           ///< [m], every node counts the same
  int largest_node = 0;        ///< where the largest is; the first non-finite node if there is one
};

/// How far two surfaces are apart, whatever their meshes. All NaN if a position is not finite.
/// Distances are taken at the nodes, so the true Hausdorff distance can be larger by up to one edge
/// length.
struct SurfaceDistance {
  double hausdorff = 0.0;     ///< larger of the two largest distances [m]
  double hausdorff_95 = 0.0;  ///< larger of the two 95th percentiles [m]
  double chamfer = 0.0;       ///< mean of the two means [m]
  OneSidedDistance a_to_b;
  OneSidedDistance b_to_a;
};

/// Distance of each point to the surface. n [m]. Shapes: points 3 x n [m], n >= 1. Throws
/// InvalidArgument.
[[nodiscard]] VectorX<double> distances_to_surface(ConstMatrix3XRef<double> points,
                                                   const Surface& surface);

/// Symmetric node-to-surface distance. Throws InvalidArgument for a surface without triangles or
/// with wrong indices.
[[nodiscard]] SurfaceDistance surface_distance(const Surface& a, const Surface& b);

}  // namespace weft::validation
