#pragma once

// Tested by tests/engines/attach_test.cpp.

#include <Eigen/Geometry>

#include <weft/core/types.hpp>

namespace weft::scenes {

/// Place and orientation of a rigid frame in the world.
struct Pose {
  Vector3<double> position{0, 0, 0};  ///< [m]
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
};

}  // namespace weft::scenes
