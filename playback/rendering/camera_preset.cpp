#include <weft/playback/rendering/camera_preset.hpp>

#include <algorithm>
#include <cmath>
#include <string>

#include <Eigen/Geometry>

#include <weft/core/error.hpp>
#include <weft/playback/rendering/view.hpp>

namespace weft::scenes {
namespace {

/// Room around the ball that holds the scene.
constexpr double kMargin = 1.05;

/// From the middle of the scene to the camera.
Vector3<double> direction_of(std::string_view preset) {
  if (preset == "front") return Vector3<double>::UnitZ();
  if (preset == "back") return -Vector3<double>::UnitZ();
  if (preset == "right") return Vector3<double>::UnitX();
  if (preset == "left") return -Vector3<double>::UnitX();
  if (preset == "top") return Vector3<double>::UnitY();
  if (preset == "bottom") return -Vector3<double>::UnitY();
  if (preset == "iso") return Vector3<double>::Ones().normalized();
  std::string names;
  for (const std::string_view name : kCameraPresets) names += " " + std::string(name);
  throw InvalidArgument("camera '" + std::string(preset) + "', expected one of" + names);
}

}  // namespace

Camera preset_camera(const Scene& scene, std::string_view preset, double aspect_ratio) {
  Camera camera = scene.camera;
  if (preset == "scene") return camera;
  const Vector3<double> direction = direction_of(preset);
  const Stage stage = make_stage(scene);
  // The narrower of the two angles has to hold the scene.
  const double half_height = 0.5 * camera.field_of_view;
  const double half_width = std::atan(std::tan(half_height) * aspect_ratio);
  camera.target = stage.center;
  camera.position = stage.center + kMargin * stage.radius /
                                       std::sin(std::min(half_height, half_width)) * direction;
  return camera;
}

Camera turned_camera(const Camera& camera, double angle) {
  Camera turned = camera;
  turned.position = camera.target + Eigen::AngleAxisd(angle, Vector3<double>::UnitY()) *
                                        (camera.position - camera.target);
  return turned;
}

}  // namespace weft::scenes
