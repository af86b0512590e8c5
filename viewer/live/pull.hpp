#pragma once

// Tested by tests/viewer/live/pull_test.cpp.

#include <mutex>
#include <optional>

#include <weft/scenes/step_commands.hpp>
#include <weft/viewer/model/picking.hpp>

namespace weft::viewer {

/// A node that the mouse pulls to a point.
struct Pull {
  NodeId id;
  Vector3<double> target{0, 0, 0};  ///< [m]
};

/// A collider that the mouse moves: its center goes to a point.
struct Carry {
  std::size_t collider = 0;
  Vector3<double> target{0, 0, 0};  ///< [m]
};

/// Influence of the window on a run beside its laws: the pull of the mouse, colliders that it moves, and a change of the gravity of
/// rigid bodies. Without either it asks for nothing, so that the run keeps its bits.
class WindowForces final : public scenes::Controller {
 public:
  /// time_step [s] of the engine.
  WindowForces(const scenes::Scene& scene, double time_step);

  void set_pull(const std::optional<Pull>& pull);
  /// A collider without a mass goes there with at most kCarrySpeed, and stays where it is let go; one with a mass is pulled by a
  /// spring with at most three times its weight.
  void set_carry(const std::optional<Carry>& carry);
  static constexpr double kCarrySpeed = 3.0;  ///< [m/s]
  /// [m/s^2] beyond that of the scene as it was loaded.
  void set_added_gravity(const Vector3<double>& acceleration);
  /// [N] with which the last step was pulled.
  [[nodiscard]] double pull_force() const;
  /// [N] that no pull on a cloth exceeds: three times its weight on Earth.
  [[nodiscard]] double largest_force(std::size_t cloth) const;

  void steer(const scenes::SceneState& state, double end_time,
             scenes::StepCommands& commands) override;
  /// Where colliders have been moved to; nothing else of what the window asks for is part of a run.
  void serialize(StateArchive& archive) override;

 private:
  void pull(const Pull& pull, const scenes::SceneState& state, scenes::StepCommands& commands);
  void carry(std::size_t collider, double time_step, const scenes::SceneState& state,
             scenes::StepCommands& commands);

  std::vector<ClothMesh> meshes_;
  std::vector<double> rigid_masses_;    ///< [kg]; 0 for those without
  std::vector<scenes::Pose> at_rest_;   ///< of the colliders
  std::vector<Vector3<double>> moved_;  ///< [m] by which colliders without a mass are elsewhere
  double time_step_;
  mutable std::mutex mutex_;
  std::optional<Pull> pull_;
  std::optional<Carry> carry_;
  Vector3<double> added_gravity_{0, 0, 0};
  double pull_force_ = 0.0;
};

}  // namespace weft::viewer
