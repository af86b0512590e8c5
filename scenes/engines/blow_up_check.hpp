#pragma once

#include <optional>

#include <weft/scenes/simulator.hpp>

namespace weft::scenes {

/// Speed [m/s] beyond which a node counts as exploded, the same for every engine.
inline constexpr double kMaxNodeSpeed = 1e6;

/// The first node, in the order of the scene, whose position or velocity is not finite or that is
/// too fast.
[[nodiscard]] std::optional<BlowUp> first_blow_up(const SceneState& state, int step, double time);

}  // namespace weft::scenes
