#pragma once

// Tested by tests/reference/shapes_test.cpp, tests/reference/contact_test.cpp.

#include <weft/reference/rigid/rigid_motion.hpp>
#include <weft/reference/system.hpp>

namespace weft::reference {

/// Where a point is relative to a surface.
struct SurfaceDistance {
  double distance;         ///< [m], exact; negative inside
  Vector3<double> normal;  ///< unit gradient of the distance, world frame, outward
};

/// Distance of a point [m, world frame] from a shape in a pose. All shapes but the mesh are convex, so
/// the distance is a convex function of the point: distance(p + d) >= distance(p) + normal . d. Where
/// the direction is not unique (centre of a sphere, middle planes of a box, axes) the first axis is
/// taken.
[[nodiscard]] SurfaceDistance signed_distance(const Shape& shape, const Pose& pose,
                                              const Vector3<double>& point);

}  // namespace weft::reference
