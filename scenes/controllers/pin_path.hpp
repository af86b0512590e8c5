#pragma once

// Tested by tests/scenes/controllers_test.cpp, tests/engines/attach_test.cpp.

#include <cstddef>
#include <optional>
#include <vector>

#include <weft/scenes/scene.hpp>
#include <weft/scenes/step_commands.hpp>

namespace weft::scenes {

/// Leads the pins of a cloth: those that follow paths or colliders, and the others. The frame of a path stands at
/// its point of time 0 at the start, turned as it is then; each node keeps its place in it, as in
/// that of a collider:
///   x(t) = p(t) + R(t) R(0)^T (x0 - p(0)).
class PinPathController final : public Controller {
 public:
  /// cloth: number of the cloth in the scene. Throws InvalidArgument for a collider that is not in
  /// the scene or has a mass.
  PinPathController(const Scene& scene, std::size_t cloth);

  void steer(const SceneState& state, double end_time, StepCommands& commands) override;
  void serialize(StateArchive& /*archive*/) override {}

 private:
  struct Lead {
    std::optional<PathMotion> motion;     ///< otherwise a collider leads
    std::optional<std::size_t> collider;  ///< its number in the scene
    Pose start;
  };
  [[nodiscard]] Lead lead_of(const MovingPin& pin, const Scene& scene) const;
  std::size_t cloth_;
  Matrix3X<double> rest_positions_;  ///< of the pinned nodes [m]
  Matrix3X<double> velocities_;      ///< of those without a path [m/s]
  std::vector<Lead> leads_;
  std::vector<std::optional<std::size_t>> leads_of_nodes_;  ///< of each pinned node
};

/// Whether something leads the pin: its velocity does not.
[[nodiscard]] bool is_lead(const MovingPin& pin);

/// Where a node is that keeps its place in a frame: place + R R0^T (x0 - p0).
[[nodiscard]] Vector3<double> carried(const Pose& start, const Pose& now,
                                      const Vector3<double>& rest_position);

}  // namespace weft::scenes
