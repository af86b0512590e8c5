#include <weft/validation/referee/recorded_result.hpp>

#include <gtest/gtest.h>

#include <weft/core/error.hpp>
#include <weft/scenes/controllers/collider_path.hpp>

#include "tests/scenes/recording/recording_samples.hpp"

namespace weft::validation {
namespace {

using scenes::samples::TemporaryFolder;

/// A cloth of 2 x 2 nodes, a fixed box and one that is led.
scenes::Scene make_scene() {
  scenes::Scene scene;
  scene.name = "small";
  scene.summary = "Shows a small scene.";
  scene.world.frame_interval = 0.02;
  scenes::Cloth cloth;
  cloth.name = "cloth";
  cloth.grid().nodes = {2, 2};
  scene.cloths.push_back(cloth);
  scenes::Collider box;
  box.name = "box";
  box.shape = scenes::BoxShape{{0.1, 0.1, 0.1}};
  scene.colliders.push_back(box);
  box.name = "led";
  box.path = scenes::Path{.times = {0, 0.05, 0.1}, .points = {{0, 0, 0}, {0, 1, 0}, {0, 1, 1}}};
  scene.colliders.push_back(box);
  return scene;
}

std::vector<scenes::SceneState> make_frames(const scenes::Scene& scene) {
  std::vector<scenes::SceneState> frames;
  const Matrix3X<double> rest = scenes::make_mesh(scene.cloths[0]).rest_positions;
  for (int f = 0; f < 4; ++f) {
    scenes::SceneState state;
    state.time = f * scene.world.frame_interval;
    state.cloths.push_back({"cloth", rest, 0.0 * rest});
    for (const scenes::Collider& collider : scene.colliders) {
      const scenes::Pose pose = scenes::prescribed_pose(collider, state.time);
      state.rigids.push_back({collider.name, pose.position, pose.orientation});
    }
    frames.push_back(state);
  }
  return frames;
}

template <class Change>
std::string fault_of(const Change& change) {
  const TemporaryFolder folder;
  const scenes::Scene scene = make_scene();
  std::vector<scenes::SceneState> frames = make_frames(scene);
  for (scenes::SceneState& frame : frames) change(frame);
  {
    scenes::RecordingWriter writer(folder / "a.weftrec", scene, {},
                                   scenes::StoredPrecision::kFloat64);
    for (const scenes::SceneState& frame : frames) writer.add_frame(frame);
    writer.finish();
  }
  try {
    check_frames(scenes::RecordingReader(folder / "a.weftrec"), "a.weftrec", scene);
  } catch (const InvalidArgument& error) {
    return error.what();
  }
  return "none";
}

TEST(AskTheSame, LooksAtBodiesAndLawsAlone) {
  const scenes::Scene scene = make_scene();
  scenes::Scene other = scene;
  other.name = "copy";
  other.world.time_step = 1e-4;
  other.world.duration = 3.0;
  other.bullet.position_iterations = 3;
  other.reference.integrator = scenes::Integrator::kImplicitEuler;
  other.camera.position = {1, 1, 1};
  EXPECT_TRUE(ask_the_same(scene, other));
  const auto differs = [&](auto change) {
    scenes::Scene changed = scene;
    change(changed);
    return !ask_the_same(scene, changed);
  };
  EXPECT_TRUE(differs([](scenes::Scene& s) { s.world.gravity.y() = -9.8; }));
  EXPECT_TRUE(differs([](scenes::Scene& s) { s.cloths[0].friction = 0.4; }));
  EXPECT_TRUE(differs([](scenes::Scene& s) { s.cloths[0].velocity.x() = 0.1; }));
  EXPECT_TRUE(differs([](scenes::Scene& s) { s.cloths[0].grid().center.x() = 1e-9; }));
  EXPECT_TRUE(differs([](scenes::Scene& s) { s.cloths[0].pins = {scenes::CornerPin{}}; }));
  EXPECT_TRUE(differs([](scenes::Scene& s) { s.colliders[0].position.x() = 0.1; }));
  EXPECT_TRUE(differs([](scenes::Scene& s) { s.colliders.pop_back(); }));
}

TEST(CheckFrames, TakesFramesOfTheScene) {
  EXPECT_EQ(fault_of([](scenes::SceneState&) {}), "none");
  // Bullet's steps in single precision.
  EXPECT_EQ(fault_of([](scenes::SceneState& state) { state.time *= 1 + 3e-8; }), "none");
}

// Comparisons go frame by frame: a recording at another rate would otherwise be compared with other times.
TEST(CheckFrames, RefusesOtherTimes) {
  EXPECT_EQ(
      fault_of([](scenes::SceneState& state) { state.time *= 2; }),
      "a.weftrec: frame 1, t = 0.04 s: expected t = 0.02 s: a frame every 0.02 s from 0 on, as "
      "scene 'small' has them (weft trim --every leaves out frames)");
  EXPECT_NE(
      fault_of([](scenes::SceneState& state) { state.time += 0.02; }).find("frame 0, t = 0.02 s"),
      std::string::npos);
}

TEST(CheckFrames, RefusesOtherBodies) {
  EXPECT_NE(fault_of([](scenes::SceneState& state) {
              if (state.time > 0.03) state.rigids[0].position.y() = 0.01;
            }).find("frame 2, t = 0.04 s: collider 'box' is 0.01 m and 0 rad from where the scene"),
            std::string::npos);
  EXPECT_NE(fault_of([](scenes::SceneState& state) {
              state.rigids[0].orientation = Eigen::AngleAxisd(0.1, Vector3<double>::UnitY());
            }).find("collider 'box' is 0 m and 0.1 rad"),
            std::string::npos);
  // Led colliders count where the path has them at that time.
  EXPECT_NE(fault_of([](scenes::SceneState& state) {
              state.rigids[1].position.setZero();
            }).find("collider 'led' is "),
            std::string::npos);
}

TEST(CheckFrames, RefusesAnotherNumberOfNodes) {
  const TemporaryFolder folder;
  scenes::Scene finer = make_scene();
  finer.cloths[0].grid().nodes = {3, 3};
  {
    scenes::RecordingWriter writer(folder / "a.weftrec", finer, {},
                                   scenes::StoredPrecision::kFloat64);
    for (const scenes::SceneState& frame : make_frames(finer)) writer.add_frame(frame);
    writer.finish();
  }
  const scenes::RecordingReader reader(folder / "a.weftrec");
  try {
    check_frames(reader, "a.weftrec", make_scene());
    FAIL() << "nine nodes are not four";
  } catch (const InvalidArgument& error) {
    EXPECT_STREQ(
        error.what(),
        "a.weftrec: frame 0, t = 0 s: cloth 'cloth' has 9 nodes, expected the 4 of the scene");
  }
}

TEST(CheckFrames, RefusesARecordingWithoutFrames) {
  const TemporaryFolder folder;
  {
    scenes::RecordingWriter(folder / "a.weftrec", make_scene(), {},
                            scenes::StoredPrecision::kFloat64)
        .finish();
  }
  EXPECT_THROW(
      check_frames(scenes::RecordingReader(folder / "a.weftrec"), "a.weftrec", make_scene()),
      InvalidArgument);
}

}  // namespace
}  // namespace weft::validation
