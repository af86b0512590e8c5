#pragma once

#include <memory>
#include <optional>
#include <vector>

#include <weft/custom_forces/core/position_limits.hpp>
#include <weft/custom_forces/core/types.hpp>
#include <weft/scenes/motion/pose.hpp>
#include <weft/scenes/simulator.hpp>

namespace weft::scenes {

/// What shall happen to one cloth in the step that begins.
struct ClothSteering {
  /// Where the pinned nodes are at the end of the step, 3 x mesh.pinned.size() [m], in the order of
  /// mesh.pinned. Empty: the pins move as the mesh says.
  Matrix3X<double> pinned_positions;
  /// Forces beside those of the laws, 3 x n [N], constant over the step. Empty: none.
  Matrix3X<double> node_forces;
  /// Where the free nodes may be at the end of the step. Empty: anywhere.
  PositionLimits limits;
};

/// What shall happen in the step that begins, in the order of the scene's cloths and colliders.
struct Steering {
  std::vector<ClothSteering> cloths;
  /// Of the colliders that are led: where they are at the end of the step. The others: none.
  std::vector<std::optional<Pose>> colliders;
};

/// Steers bodies from what is seen of them: the same for every engine.
class Controller {
 public:
  virtual ~Controller() = default;

  /// Adds to what the others ask for. state is that at the start of the step; end_time [s].
  virtual void steer(const SceneState& state, double end_time, Steering& steering) = 0;
};

}  // namespace weft::scenes
