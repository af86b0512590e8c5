#pragma once

// Tested by tests/viewer/model/orbit_test.cpp.

#include <weft/scenes/scene.hpp>

namespace weft::viewer {

/// Moves a camera as a mouse or keys ask; the target stays in the middle of the picture.

/// Turns around the target: azimuth to the right, elevation upwards [rad]. Straight above and below
/// are kept out, where the horizon would flip.
void rotate(scenes::Camera& camera, double azimuth, double elevation);

/// factor > 1 comes nearer. The distance stays within 1e-3 and 1e5 m.
void zoom(scenes::Camera& camera, double factor);

/// Moves camera and target within the picture's plane, in heights of the picture at the target.
void pan(scenes::Camera& camera, double right, double up);

/// The axes of a camera's picture.
struct CameraFrame {
  Vector3<double> right;
  Vector3<double> up;
  Vector3<double> back;  ///< from the target to the camera
};
[[nodiscard]] CameraFrame frame_of(const scenes::Camera& camera);

}  // namespace weft::viewer
