#pragma once

// Tested by tests/playback/rendering/renderer_test.cpp.

#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include <weft/scenes/scene.hpp>
#include <weft/scenes/simulator.hpp>

namespace weft::scenes {

/// What stays the same for every picture of a scene, so that a film does not jump.
struct Stage {
  Vector3<double> center{0, 0, 0};  ///< [m] origin of everything that is drawn
  double radius = 1.0;              ///< [m] of the scene at rest around it
  bool ground_is_collider = false;  ///< else the ground is decoration and hides nothing
  bool ground_is_visible = true;
  std::optional<Rgb> ground_color = {};      ///< none: that of the backdrop
  Vector3<double> ground_position{0, 0, 0};  ///< [m]
  Eigen::Quaterniond ground_orientation = Eigen::Quaterniond::Identity();  ///< y axis is the normal
};

[[nodiscard]] Stage make_stage(const Scene& scene);

/// How far the body that the camera follows has moved; zero if it follows none. [m]
[[nodiscard]] Vector3<double> camera_shift(const Scene& scene, const std::vector<ClothMesh>& meshes,
                                           const SceneState& state);

/// Radius around the stage's centre, shifted, that holds the state too, in coarse steps so that
/// shadows keep still, and at most eight times the scene's own: one run-away node must not cost all
/// others their shadow. [m]
[[nodiscard]] double state_radius(const Stage& stage, const Vector3<double>& shift,
                                  const SceneState& state);

/// Directions towards the lights of a photo studio, chosen from the camera so that folds show from
/// every side.
struct StudioLights {
  Eigen::Vector3f key;
  Eigen::Vector3f fill;
  Eigen::Vector3f rim;
};
[[nodiscard]] StudioLights studio_lights(const Camera& camera);

/// Axes of a camera in the world, as columns: to the right, upwards, and backwards, away from what it looks at.
[[nodiscard]] Eigen::Matrix3d camera_axes(const Camera& camera);

/// Camera of a picture, relative to the stage's centre.
struct View {
  Eigen::Matrix4f clip_from_world;
  Eigen::Vector3f eye;
};
[[nodiscard]] View make_view(const Camera& camera, const Stage& stage, double aspect_ratio);

/// Parallel light: maps the ball of the given radius around the centre to the clip cube.
[[nodiscard]] Eigen::Matrix4f light_matrix(const Eigen::Vector3f& towards_light,
                                           const Eigen::Vector3f& center, double radius);

/// Width of the ground's grid cells: 1, 2 or 5 times a power of ten, about a fifth of the radius.
/// [m]
[[nodiscard]] double grid_cell(double radius);

}  // namespace weft::scenes
