#pragma once

// Tested by tests/scenes/controllers_test.cpp, tests/scenes/controllers/detail_test.cpp.

#include <memory>
#include <optional>
#include <vector>

#include <weft/core/error.hpp>
#include <weft/core/state_archive.hpp>
#include <weft/core/types.hpp>
#include <weft/mesh/position_limits.hpp>
#include <weft/scenes/motion/pose.hpp>
#include <weft/scenes/simulator.hpp>

namespace weft::scenes {

/// Where all nodes of a cloth are at the end of a step.
struct Placement {
  Matrix3X<double> positions;   ///< 3 x n [m]
  Matrix3X<double> velocities;  ///< 3 x n [m/s]
};

/// What shall happen to one cloth in the step that begins.
struct ClothCommands {
  /// Where the pinned nodes are at the end of the step, 3 x mesh.pinned.size() [m], in the order of
  /// mesh.pinned. Empty: the pins move as the mesh says.
  Matrix3X<double> pinned_positions;
  /// Forces beside those of the laws, 3 x n [N], constant over the step. Empty: none.
  Matrix3X<double> node_forces;
  /// Where the free nodes may be at the end of the step. Empty: anywhere.
  PositionLimits limits;
  /// Where an animation has the nodes at the end of the step, 3 x n [m], for controllers that come
  /// later. Empty: there is none.
  Matrix3X<double> animated_positions;
  /// Set: the cloth is not simulated in this step, it meets nothing, and is there at its end. The
  /// first step without it goes on from there.
  std::optional<Placement> placement;
};

/// What pushes a collider with a mass over the step, beside gravity and contacts.
struct Push {
  Vector3<double> force{0, 0, 0};   ///< [N]
  Vector3<double> torque{0, 0, 0};  ///< [N m], about RigidState::position
};

/// What shall happen in the step that begins, in the order of the scene's cloths and colliders.
struct StepCommands {
  std::vector<ClothCommands> cloths;
  /// Where the colliders that are led are at the end of the step. The others: none.
  std::vector<std::optional<Pose>> colliders;
  /// The push on every collider; those without a mass feel nothing.
  std::vector<Push> pushes;
};

/// Steers bodies from what is seen of them: the same for every engine.
class Controller {
 public:
  virtual ~Controller() = default;

  /// Adds to what the others ask for. state is that at the start of the step; end_time [s].
  virtual void steer(const SceneState& state, double end_time, StepCommands& commands) = 0;

  /// What it knows from the steps before, for snapshots. One that knows nothing writes nothing. A controller that does not
  /// say refuses the snapshot, because its memory would be lost in silence.
  virtual void serialize(StateArchive& /*archive*/) {
    throw InvalidArgument(
        "snapshot: a controller does not say what it knows from earlier steps, expected one with "
        "serialize()");
  }
};

}  // namespace weft::scenes
