#pragma once

// Tested by tests/scenes/controllers_test.cpp.

#include <cstddef>

#include <weft/scenes/scene.hpp>
#include <weft/scenes/step_commands.hpp>

namespace weft::scenes {

/// See Roll. A torque about the horizontal axis across the way to the target,
///   clamp((omega* - omega) / turn_rate) torque,   omega* = turn_rate min(1, |d| / arrival),
/// with d the way from the centre of mass to the target and omega the rate of rolling that the
/// angular momentum of the body stands for. It is shared out so that every node feels the same
/// angular acceleration: f_i = m_i alpha x r_i.
class RollController final : public Controller {
 public:
  /// cloth: number of roll.cloth in its scene. Throws InvalidArgument for values out of their
  /// domain.
  RollController(const Roll& roll, std::size_t cloth, const ClothMesh& mesh);

  void steer(const SceneState& state, double end_time, StepCommands& commands) override;
  void serialize(StateArchive& /*archive*/) override {}

 private:
  Roll roll_;
  PathMotion target_;
  std::size_t cloth_;
  VectorX<double> masses_;  ///< [kg]
};

}  // namespace weft::scenes
