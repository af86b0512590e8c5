#pragma once

// Tested by tests/engines/attach_test.cpp.

#include <cstddef>
#include <vector>

#include <weft/scenes/scene.hpp>
#include <weft/scenes/step_commands.hpp>

namespace weft::scenes {

/// See Attach. With x and u a node's place and velocity, a and w those of its place in the collider,
///   f = stiffness (a - x) + damping (w - u)
/// on the node, taken at the start of the step, and -f at x on the collider, so that the pair keeps
/// its momentum and its angular momentum. The step must be shorter than 2 sqrt(m / stiffness) of the
/// lightest node.
class AttachController final : public Controller {
 public:
  /// cloth: number of attach.cloth in the scene. Throws InvalidArgument for an unknown region or
  /// collider, a cloth that tears and values out of their domain.
  AttachController(const Attach& attach, std::size_t cloth, const Scene& scene);

  void steer(const SceneState& state, double end_time, StepCommands& commands) override;
  void serialize(StateArchive& /*archive*/) override {}

 private:
  Attach attach_;
  std::size_t cloth_;
  std::size_t collider_ = 0;
  bool is_free_ = false;  ///< the collider has a mass
  std::vector<int> nodes_;
  std::vector<Vector3<double>> arms_;  ///< of nodes_, in the collider's frame [m]
};

}  // namespace weft::scenes
