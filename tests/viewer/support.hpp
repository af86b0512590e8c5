#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include <weft/scenes/recording/recording.hpp>

namespace weft::viewer {

/// A recording of a sheet that falls freely beside a ball that rolls, without an engine: at time t
/// the sheet is at -drop t, and the ball at x = t. Frames every tenth of a second.
class FallingSheet {
 public:
  FallingSheet(const std::filesystem::path& path, double drop, int num_frames)
      : drop_(drop), scene_(scene_of(num_frames)), mesh_(scenes::make_mesh(scene_.cloths[0])) {
    std::filesystem::remove(path);
    writer_ = std::make_unique<scenes::RecordingWriter>(path, scene_, scenes::Provenance{},
                                                        scenes::StoredPrecision::kFloat64);
  }

  void add_frames(int count) {
    for (int i = 0; i < count; ++i, ++num_frames_) {
      scenes::SceneState state;
      state.time = 0.1 * num_frames_;
      state.cloths.push_back(
          {"sheet", mesh_.rest_positions, Matrix3X<double>::Zero(3, mesh_.num_nodes())});
      state.cloths[0].positions.row(1).array() -= drop_ * state.time;
      state.cloths[0].velocities.row(1).array() = -drop_;
      state.rigids = {{"stone"}, {"ball", {state.time, 0.0, 0.0}}};
      writer_->add_frame(state);
    }
  }
  [[nodiscard]] int num_committed() const { return writer_->committed().frames; }
  void finish() {
    (void)writer_->finish();
    writer_.reset();
  }

 private:
  static scenes::Scene scene_of(int num_frames) {
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
    return scene;
  }

  double drop_;
  scenes::Scene scene_;
  ClothMesh mesh_;
  std::unique_ptr<scenes::RecordingWriter> writer_;
  int num_frames_ = 0;
};

inline std::filesystem::path write_recording(const std::string& name, double drop, int num_frames) {
  const std::filesystem::path path = testing::TempDir() + "weft_viewer_" + name + ".weftrec";
  FallingSheet sheet(path, drop, num_frames);
  sheet.add_frames(num_frames);
  sheet.finish();
  return path;
}

}  // namespace weft::viewer
