#pragma once

// Tested by tests/scenes/controllers_test.cpp, tests/engines/attach_test.cpp.

#include <cstddef>

#include <weft/scenes/scene.hpp>
#include <weft/scenes/step_commands.hpp>

namespace weft::scenes {

/// The pose at a time [s] of a collider that does not move freely: on its path, or as it always is.
[[nodiscard]] inline Pose prescribed_pose(const Collider& collider, double time) {
  if (!collider.path) return {collider.position, collider.orientation};
  Pose pose = PathMotion(*collider.path).pose(time);
  pose.orientation = (pose.orientation * collider.orientation).normalized();
  return pose;
}

/// Where a collider is at the start.
[[nodiscard]] inline Pose start_pose(const Collider& collider) {
  return prescribed_pose(collider, 0.0);
}

/// Leads a collider along its path.
class ColliderPathController final : public Controller {
 public:
  /// index: number of the collider in its scene.
  ColliderPathController(const Collider& collider, std::size_t index)
      : collider_(index), motion_(*collider.path), orientation_(collider.orientation) {}

  void steer(const SceneState&, double end_time, StepCommands& commands) override {
    Pose pose = motion_.pose(end_time);
    pose.orientation = (pose.orientation * orientation_).normalized();
    commands.colliders[collider_] = pose;
  }
  void serialize(StateArchive& /*archive*/) override {}

 private:
  std::size_t collider_;
  PathMotion motion_;
  Eigen::Quaterniond orientation_;
};

}  // namespace weft::scenes
