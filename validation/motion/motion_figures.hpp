#pragma once

#include <functional>
#include <string>
#include <vector>

#include <weft/scenes/scene.hpp>
#include <weft/scenes/simulator.hpp>

namespace weft::validation {

/// States of a scene, the start first.
using MotionFrames = std::vector<scenes::SceneState>;

/// A history that no right solver writes, which a figure must notice.
enum class WrongMotion {
  kFrozen,     ///< standing_still()
  kUntouched,  ///< untouched()
  kPushed,  ///< untouched(), and from the middle on all drifts aside at 0.5 m/s and is half as fast again
};
[[nodiscard]] std::string to_string(WrongMotion wrong);

/// A number that tells whether a scene went as it must, from states, masses and laws alone.
struct MotionFigure {
  std::string name;  ///< "height of the highest node at 1 s"
  std::string unit;  ///< "m"
  std::function<double(const scenes::Scene&, const MotionFrames&)> of;
  /// How far it may be from what is right, in its unit.
  double allowed = 0.0;
  /// A bound that holds by theory: what is right need not be known from another run.
  bool is_bound = false;
  WrongMotion wrong = WrongMotion::kFrozen;
  /// allowed is a share of what is right.
  bool is_relative = false;

  /// How far a value is from what is right, to be compared with allowed. right: not looked at if is_bound.
  [[nodiscard]] double deviation(double value, double right) const;
};

/// A scene, how short explicit steps must be to tell what happens in it, and what is looked at.
struct MotionScene {
  scenes::Scene scene;
  double exact_step = 0.0;  ///< [s], a whole part of the frame interval
  std::vector<MotionFigure> figures;
};

/// The scenes of motion_scenes.hpp in which something falls, is hit or carries.
[[nodiscard]] std::vector<MotionScene> judged_motions();

/// Impacts on a free sheet at mass ratios of 1 to 1000 and 1 to 50 m/s, a ball that bounces, one that rests on a trampoline for 60 s.
[[nodiscard]] std::vector<MotionScene> judged_impacts();

/// Figures that other scenes need too.
/// Largest total energy after the start above that at the start [J], never below 0. The scene says with which step it was run.
[[nodiscard]] double energy_gained(const scenes::Scene& scene, const MotionFrames& frames);
/// Largest change of the momentum of everything that moves, over that at the start [-].
[[nodiscard]] double momentum_changed(const scenes::Scene& scene, const MotionFrames& frames);
/// Deepest place of a node in a collider [m], >= 0, over all states.
[[nodiscard]] double deepest_node(const scenes::Scene& scene, const MotionFrames& frames);

/// What would happen if nothing met anything: bodies with a mass fly and fall, a cloth that is not pinned falls as it lies, others stay.
/// As many states as the scene has frames.
[[nodiscard]] MotionFrames untouched(const scenes::Scene& scene);
/// Everything stays where it starts.
[[nodiscard]] MotionFrames standing_still(const scenes::Scene& scene);

[[nodiscard]] MotionFrames wrong_motion(const scenes::Scene& scene, WrongMotion wrong);

/// Frames of a simulator from the start on; they end where it blows up. Throws as Simulator::load().
[[nodiscard]] MotionFrames frames_of(scenes::Simulator& simulator, const scenes::Scene& scene);

}  // namespace weft::validation
