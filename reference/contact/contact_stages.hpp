#pragma once

// Tested by tests/reference/contact_test.cpp, tests/reference/friction_test.cpp.

#include <weft/reference/contact/contact_model.hpp>
#include <weft/reference/contact/touches.hpp>

namespace weft::reference {

/// The two parts that both contact models are made of.

struct PositionStage {
  bool friction = true;  ///< Coulomb friction on the slip of the step
  bool change_end_velocity =
      true;  ///< impulses act on end velocities too; else only positions move
};

/// Changes mean velocities so that no node ends the step inside. The surface is linearised where
/// the node would end and this is repeated until the normals stand still (implicit normal), so that
/// a node rests on a curved surface without creep. All shapes are convex: even one pass leaves no
/// node inside a fixed collider.
/// touches: filled with what pushed beside nodes on colliders.
[[nodiscard]] ContactOutcome run_position_stage(const System& system, const PositionStage& stage,
                                                SystemStep& step, Touches& touches);

/// Changes end velocities so that no touching node approaches its surface, with or without
/// friction; nor what touched in the position stage.
[[nodiscard]] ContactOutcome run_velocity_stage(const System& system, bool friction,
                                                const Touches& touches, SystemStep& step);

/// The point that a position-stage impulse on a node acts at, relative to the collider's: see
/// make_impulse_contact() [m].
[[nodiscard]] Vector3<double> position_stage_lever(const System& system, const SystemStep& step,
                                                   std::size_t collider, std::size_t body,
                                                   int node);

/// Passes over the linearised surface. The error of the normal shrinks by (distance per step /
/// radius) per pass, so ten are far more than any step short enough to be of use needs on a smooth
/// surface. At an edge of a box a normal may flip for ever; from the tenth pass on the planes found
/// so far stay, each of which keeps its node outside, and only new contacts are added.
inline constexpr int kSmoothPasses = 10;
inline constexpr int kMaxPasses = 20;
/// Change of a normal that counts as standing still [-]: thousand roundings.
inline constexpr double kNormalTolerance = 1e-12;
/// A node this close to its margin touches [m]: above the rounding of coordinates below 1e5 m,
/// below any margin.
inline constexpr double kTouchDistance = 1e-10;

}  // namespace weft::reference
