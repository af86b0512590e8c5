#include <weft/viewer/model/orbit.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <weft/playback/rendering/view.hpp>

namespace weft::viewer {
namespace {

constexpr double kHighest = 0.49 * std::numbers::pi;  // [rad] above the horizon
constexpr double kNearest = 1e-3;                     // [m]
constexpr double kFarthest = 1e5;                     // [m]

}  // namespace

CameraFrame frame_of(const scenes::Camera& camera) {
  const Eigen::Matrix3d axes = scenes::camera_axes(camera);
  return {axes.col(0), axes.col(1), axes.col(2)};
}

void rotate(scenes::Camera& camera, double azimuth, double elevation) {
  const Vector3<double> arm = camera.position - camera.target;
  const double distance = arm.norm();
  const double around = std::atan2(arm.x(), arm.z()) + azimuth;
  const double above = std::clamp(std::asin(std::clamp(arm.y() / distance, -1.0, 1.0)) + elevation,
                                  -kHighest, kHighest);
  camera.position = camera.target + distance * Vector3<double>(std::cos(above) * std::sin(around),
                                                               std::sin(above),
                                                               std::cos(above) * std::cos(around));
}

void zoom(scenes::Camera& camera, double factor) {
  const Vector3<double> arm = camera.position - camera.target;
  const double distance = std::clamp(arm.norm() / factor, kNearest, kFarthest);
  camera.position = camera.target + distance * arm.normalized();
}

void pan(scenes::Camera& camera, double right, double up) {
  const CameraFrame frame = frame_of(camera);
  const double height =
      2.0 * std::tan(0.5 * camera.field_of_view) * (camera.position - camera.target).norm();  // [m]
  const Vector3<double> shift = height * (right * frame.right + up * frame.up);
  camera.position += shift;
  camera.target += shift;
}

}  // namespace weft::viewer
