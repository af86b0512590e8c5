#include <weft/validation/referee/recorded_result.hpp>

#include <cmath>

#include <fmt/format.h>

#include <weft/core/error.hpp>
#include <weft/scenes/characters/start_state.hpp>
#include <weft/scenes/controllers/collider_path.hpp>
#include <weft/scenes/format/scene_file.hpp>

namespace weft::validation {
namespace {

/// How far a frame's time may be from the scene's, as a part of the frame interval [-]: Bullet rounds its steps.
constexpr double kTimeTolerance = 1e-3;
/// How far a collider may be turned from where the scene has it [rad]: single precision stays a hundred times below.
constexpr double kTurnTolerance = 1e-4;

std::string comparable(scenes::Scene scene) {
  scene.name = "same";
  scene.summary = "Shows the same.";
  scene.engines.clear();
  scene.world.time_step = scene.world.frame_interval = scene.world.duration = 1.0;
  scene.world.implicit_time_step.reset();
  scene.bullet = {};
  scene.reference = {};
  scene.camera = {};
  for (scenes::Cloth& cloth : scene.cloths) cloth.appearance = {};
  for (scenes::Collider& collider : scene.colliders) collider.appearance = {};
  return scenes::write_scene(scene);
}

/// Looks at one frame after another.
class FrameCheck {
 public:
  FrameCheck(std::string file, const scenes::Scene& scene)
      : file_(std::move(file)), scene_(scene), tolerance_(scenes::start_tolerance(scene)) {
    for (const scenes::Cloth& cloth : scene.cloths) {
      num_nodes_.push_back(scenes::num_nodes(cloth.source));
    }
  }

  void check(int frame, const scenes::SceneState& state) const {
    check_time(frame, state.time);
    if (state.cloths.size() != scene_.cloths.size() ||
        state.rigids.size() != scene_.colliders.size()) {
      refuse(frame, state.time,
             fmt::format("{} cloths and {} rigid bodies, expected {} and {}", state.cloths.size(),
                         state.rigids.size(), scene_.cloths.size(), scene_.colliders.size()));
    }
    for (std::size_t c = 0; c < state.cloths.size(); ++c) {
      const scenes::ClothState& cloth = state.cloths[c];
      if (cloth.topology == nullptr && cloth.positions.cols() == num_nodes_[c]) continue;
      refuse(
          frame, state.time,
          fmt::format("cloth '{}' has {} nodes{}, expected the {} of the scene", cloth.name,
                      cloth.positions.cols(), cloth.topology ? " and is torn" : "", num_nodes_[c]));
    }
    for (std::size_t r = 0; r < state.rigids.size(); ++r) {
      if (!scene_.colliders[r].mass) check_place(frame, state, r);
    }
  }

 private:
  [[noreturn]] void refuse(int frame, double time, const std::string& fault) const {
    throw InvalidArgument(fmt::format("{}: frame {}, t = {:.6g} s: {}", file_, frame, time, fault));
  }

  void check_time(int frame, double time) const {
    const double interval = scene_.world.frame_interval;
    const double expected = frame * interval;
    if (std::abs(time - expected) <= kTimeTolerance * interval) return;
    refuse(frame, time,
           fmt::format("expected t = {:.6g} s: a frame every {:.6g} s from 0 on, as scene '{}' has "
                       "them (weft trim --every leaves out frames)",
                       expected, interval, scene_.name));
  }

  void check_place(int frame, const scenes::SceneState& state, std::size_t index) const {
    const scenes::RigidState& rigid = state.rigids[index];
    const scenes::Pose pose = scenes::prescribed_pose(scene_.colliders[index], state.time);
    const double distance = (rigid.position - pose.position).norm();
    const double turn = rigid.orientation.angularDistance(pose.orientation);
    if (distance <= tolerance_ && turn <= kTurnTolerance) return;
    refuse(frame, state.time,
           fmt::format("collider '{}' is {:.3g} m and {:.3g} rad from where the scene has it, "
                       "expected at most {:.3g} m and {:.3g} rad",
                       rigid.name, distance, turn, tolerance_, kTurnTolerance));
  }

  std::string file_;
  const scenes::Scene& scene_;
  double tolerance_;  ///< [m]
  std::vector<int> num_nodes_;
};

}  // namespace

RecordedResult recorded_result(const std::filesystem::path& path) {
  const scenes::RecordingReader reader(path);
  RecordedResult result;
  result.path = path;
  result.scene = reader.scene();
  result.precision = reader.precision();
  return result;
}

bool ask_the_same(const scenes::Scene& a, const scenes::Scene& b) {
  return comparable(a) == comparable(b);
}

void check_frames(const scenes::RecordingReader& reader, const std::string& file,
                  const scenes::Scene& scene) {
  if (reader.num_frames() == 0) {
    throw InvalidArgument(file + ": has no frame to judge, expected at least one");
  }
  const FrameCheck check(file, scene);
  for (int frame = 0; frame < reader.num_frames(); ++frame) {
    check.check(frame, reader.frame(frame));
  }
}

}  // namespace weft::validation
