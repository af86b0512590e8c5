#pragma once

#include <Eigen/Geometry>

#include <weft/scenes/scene.hpp>

namespace weft::validation {

/// Where a shape stands: its centre and its orientation (of any norm > 0; it is normalised on use).
struct Pose {
  Vector3<double> position{0, 0, 0};  ///< [m]
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
};

/// Distance from a point to the surface of a shape [m], negative inside; for a box the exact
/// Euclidean distance. NaN if the point or the pose is not finite. Written apart from the engines'
/// own contact code, so that it checks it.
[[nodiscard]] double signed_distance(const scenes::Shape& shape, const Pose& pose,
                                     const Vector3<double>& point);

}  // namespace weft::validation
