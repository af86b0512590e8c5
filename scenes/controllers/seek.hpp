#pragma once

// Tested by tests/scenes/controllers_test.cpp.

#include <cstddef>
#include <vector>

#include <weft/scenes/scene.hpp>
#include <weft/scenes/step_commands.hpp>

namespace weft::scenes {

/// See Seek. With c and u the centre and mean velocity of the region, both horizontal, d the way to
/// the target, theta and omega angle and rate of turning of the region about the vertical:
///   force   clamp((u* - u) / speed) force,              u* = speed min(1, |d| / arrival) d / |d|
///   torque  clamp((omega* - omega) / turn_rate) torque, omega* = turn_rate clamp(angle / kEase)
/// where clamp keeps to a size of 1 and angle is from the front to the target. Both are shared out
/// by mass, the torque over the arms of the nodes.
class SeekController final : public Controller {
 public:
  /// cloth: number of seek.cloth in its scene. Throws InvalidArgument for an unknown region and
  /// values out of their domain.
  SeekController(const Seek& seek, std::size_t cloth, const ClothMesh& mesh);

  static constexpr double kEase = 0.3;  ///< [rad] from which on it turns slower

  void steer(const SceneState& state, double end_time, StepCommands& commands) override;
  void serialize(StateArchive& /*archive*/) override {}

 private:
  struct Motion;
  [[nodiscard]] Motion motion_of(const ClothState& cloth) const;

  Seek seek_;
  PathMotion target_;
  std::size_t cloth_;
  std::vector<int> nodes_;
  std::vector<double> masses_;         ///< of nodes_ [kg]
  std::vector<Vector3<double>> arms_;  ///< of nodes_ at rest, from their centre [m]
  double total_mass_ = 0.0;            ///< [kg]
};

}  // namespace weft::scenes
