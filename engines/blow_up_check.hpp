#pragma once

// Tested by tests/engines/blow_up_engines_test.cpp.

#include <limits>
#include <optional>
#include <string>

#include <weft/scenes/simulator.hpp>

namespace weft::scenes {

/// Speed [m/s] beyond which a node or a rigid body counts as exploded, the same for every engine.
inline constexpr double kMaxNodeSpeed = 1e6;
/// The same of a rigid body's rotation [rad/s].
inline constexpr double kMaxAngularSpeed = 1e6;

/// What is wrong with a rigid body of these velocities [m/s], [rad/s]; nothing if they are finite and
/// not too fast.
[[nodiscard]] std::optional<std::string> fault_of_motion(const Vector3<double>& velocity,
                                                         const Vector3<double>& angular_velocity);

/// The first node, in the order of the scene, or else the first rigid body, whose state is not
/// finite, that is too fast, or that is farther from the origin than reach [m]. A rigid body has the
/// node 0.
[[nodiscard]] std::optional<BlowUp> first_blow_up(
    const SceneState& state, int step, double time,
    double reach = std::numeric_limits<double>::infinity());

}  // namespace weft::scenes
