#pragma once

#include <string>

#include <weft/scenes/simulator.hpp>

namespace weft::scenes {

/// By how much rounding may move a coordinate, so that a recording becomes smaller.
struct RoundingBounds {
  double position = 0.0;  ///< [m] > 0
  double velocity = 0.0;  ///< [m/s] > 0
};

/// Key of the provenance that says so.
inline constexpr const char* kRoundedKey = "rounded";

/// The bound for positions, and that for velocities by which a node would miss its place by as much after a frame
/// interval [s].
/// @throws InvalidArgument for a bound or an interval that is not > 0 and finite.
[[nodiscard]] RoundingBounds rounding_bounds(double position, double frame_interval);

/// Rounds positions and velocities of cloths, and positions and velocities of rigid bodies, to multiples of a power of two
/// that is at most twice the bound; their orientations and angular velocities stay as they are, and so does what is not
/// finite. The format is that of any recording: compression gets its gain from the bits that are zero now (bit rounding;
/// Kouznetsov, Geosci. Model Dev. 14, 2021).
void round_state(SceneState& state, const RoundingBounds& bounds);

/// "positions by at most 0.0001 m, velocities by at most 0.006 m/s"
[[nodiscard]] std::string rounding_text(const RoundingBounds& bounds);

}  // namespace weft::scenes
