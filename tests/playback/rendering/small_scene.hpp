#pragma once

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include <weft/playback/rendering/paint/color_map.hpp>
#include <weft/playback/rendering/renderer.hpp>

namespace weft::scenes {

/// A flat cloth above a fixed ball and a floor; the camera looks along -z from the front, slightly
/// from above.
inline Scene small_scene() {
  Scene scene;
  scene.name = "small";
  Cloth cloth;
  cloth.name = "cloth";
  cloth.grid().nodes = {9, 9};
  cloth.grid().size = {2.0, 2.0};
  cloth.grid().center = {0, 2.5, 0};
  scene.cloths.push_back(cloth);
  Collider ball;
  ball.name = "ball";
  ball.shape = SphereShape{0.5};
  ball.position = {2.0, 0.5, 0};
  scene.colliders.push_back(ball);
  Collider floor;
  floor.name = "floor";
  floor.shape = PlaneShape{};
  scene.colliders.push_back(floor);
  scene.camera.position = {0, 4, 10};
  scene.camera.target = {0, 1, 0};
  scene.camera.field_of_view = 0.6;
  return scene;
}

inline SceneState rest_state(const Scene& scene) {
  SceneState state;
  for (const Cloth& cloth : scene.cloths) {
    const ClothMesh mesh = make_mesh(cloth);
    state.cloths.push_back(
        {cloth.name, mesh.rest_positions, Matrix3X<double>::Zero(3, mesh.rest_positions.cols())});
  }
  for (const Collider& collider : scene.colliders) {
    state.rigids.push_back({collider.name, collider.position, collider.orientation});
  }
  return state;
}

inline RenderOptions small_options() {
  RenderOptions options;
  options.width = 320;
  options.height = 180;
  return options;
}

inline Rgb pixel(const Image& image, int column, int row) {
  const auto at = static_cast<std::size_t>(3 * (row * image.width + column));
  return {image.rgb.at(at), image.rgb.at(at + 1), image.rgb.at(at + 2)};
}

/// Where the camera shows a point, written anew from the pinhole formula: [pixel] from the left and
/// from above.
inline Eigen::Vector2d project(const Camera& camera, const Vector3<double>& point, int width,
                               int height) {
  const Vector3<double> forward = (camera.target - camera.position).normalized();
  const Vector3<double> right = forward.cross(Vector3<double>::UnitY()).normalized();
  const Vector3<double> up = right.cross(forward);
  const Vector3<double> d = point - camera.position;
  const double focal = 0.5 * height / std::tan(0.5 * camera.field_of_view);
  return {0.5 * width + focal * d.dot(right) / d.dot(forward),
          0.5 * height - focal * d.dot(up) / d.dot(forward)};
}

inline Rgb pixel_at(const Image& image, const Camera& camera, const Vector3<double>& point) {
  const Eigen::Vector2d place = project(camera, point, image.width, image.height);
  return pixel(image, static_cast<int>(place.x()), static_cast<int>(place.y()));
}

/// Largest difference of a channel.
inline int difference(const Rgb& a, const Rgb& b) {
  int largest = 0;
  for (std::size_t c = 0; c < 3; ++c) largest = std::max(largest, std::abs(a[c] - b[c]));
  return largest;
}

}  // namespace weft::scenes
