#pragma once

#include <vector>

#include <weft/scenes/recording/playback_copy.hpp>

namespace weft::scenes {

/// Energies of the cloths of a recording over time, all cloths together:
/// "cloth_kinetic_energy_J", sum of m v^2 / 2, and "cloth_height_energy_J", minus the sum of m g x, which is 0 in the first
/// frame. The skin of a character, which its bones lead, does not count. Once a cloth has torn they are NaN: how the mass of a torn node is shared out is not recorded.
[[nodiscard]] std::vector<PlaybackMetric> cloth_energies(const RecordingReader& reader);

}  // namespace weft::scenes
