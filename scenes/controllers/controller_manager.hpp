#pragma once

// Tested by tests/scenes/controllers_test.cpp.

#include <memory>
#include <string>
#include <vector>

#include <weft/scenes/scene.hpp>
#include <weft/scenes/step_commands.hpp>

namespace weft::scenes {

/// Leads a scene: its paths and controllers, and those that a program adds. An engine asks it
/// before every step.
class ControllerManager {
 public:
  ControllerManager() = default;
  /// Throws InvalidArgument for a path or a controller that does not fit the scene.
  /// added: come after those of the scene.
  explicit ControllerManager(const Scene& scene,
                             std::vector<std::shared_ptr<Controller>> added = {});

  /// Whether anything of the scene is led: if not, engines need not ask.
  [[nodiscard]] bool is_needed() const { return !controllers_.empty(); }

  /// What controllers do in a step from state to end_time [s]. The result lives until the next call.
  [[nodiscard]] const StepCommands& steer(const SceneState& state, double end_time);
  /// What the controllers know from the steps before. Throws InvalidArgument for one that does not say.
  void serialize(StateArchive& archive);

 private:
  void lead_copies(const SceneState& state);

  std::vector<std::shared_ptr<Controller>> controllers_;
  std::vector<std::vector<int>> pinned_;  ///< of each cloth's mesh, before it tears
  StepCommands commands_;
};

}  // namespace weft::scenes
