#pragma once

// Tested by tests/validation/metrics/distance/penetration_test.cpp.

#include <Eigen/Geometry>

#include <weft/scenes/scene.hpp>
#include <weft/validation/metrics/distance/shape_distance.hpp>

namespace weft::validation {

/// Where a shape stands: its centre and its orientation (of any norm > 0; it is normalised on use).
struct Pose {
  Vector3<double> position{0, 0, 0};  ///< [m]
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
};

/// Distance from a point to the surface of a shape [m], negative inside, see ShapeDistance. NaN if the point or the pose is not finite. Written apart from the engines'
/// own contact code, so that it checks it.
[[nodiscard]] double signed_distance(const scenes::Shape& shape, const Pose& pose,
                                     const Vector3<double>& point);

/// The same for many points of one shape.
[[nodiscard]] double signed_distance(const ShapeDistance& shape, const Pose& pose,
                                     const Vector3<double>& point);

}  // namespace weft::validation
