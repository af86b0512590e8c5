#pragma once

#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include <weft/scenes/recording/recording.hpp>

namespace weft::viewer {

/// A recording of a sheet that falls freely beside a ball that rolls, without an engine: at time t
/// the sheet is at -drop t, and the ball at x = t. Frames every tenth of a second.
inline std::filesystem::path write_recording(const std::string& name, double drop, int num_frames) {
  const std::filesystem::path path = testing::TempDir() + "weft_viewer_" + name + ".weftrec";
  std::filesystem::remove(path);
  scenes::Scene scene;
  scene.name = "falling";
  scene.summary = "Shows a sheet that falls";
  scene.world.duration = 0.1 * num_frames;
  scene.world.time_step = 0.1;
  scene.world.frame_interval = 0.1;
  scenes::Cloth& cloth = scene.cloths.emplace_back();
  cloth.name = "sheet";
  cloth.grid().nodes = {3, 3};
  cloth.grid().size = {1.0, 1.0};
  cloth.grid().total_mass = 0.4;
  cloth.laws = {{"gravity", {}, {{"acceleration", {0.0, -9.81, 0.0}}}}};
  for (const bool moves : {false, true}) {
    scenes::Collider& ball = scene.colliders.emplace_back();
    ball.name = moves ? "ball" : "stone";
    ball.shape = scenes::SphereShape{0.1};
    if (moves) ball.mass = 1.0;
  }
  const ClothMesh mesh = scenes::make_mesh(cloth);
  scenes::RecordingWriter writer(path, scene, {}, scenes::StoredPrecision::kFloat64);
  for (int f = 0; f < num_frames; ++f) {
    scenes::SceneState state;
    state.time = 0.1 * f;
    state.cloths.push_back(
        {"sheet", mesh.rest_positions, Matrix3X<double>::Zero(3, mesh.num_nodes())});
    state.cloths[0].positions.row(1).array() -= drop * state.time;
    state.cloths[0].velocities.row(1).array() = -drop;
    state.rigids = {{"stone"}, {"ball", {state.time, 0.0, 0.0}}};
    writer.add_frame(state);
  }
  (void)writer.finish();
  return path;
}

}  // namespace weft::viewer
