#pragma once

#include <functional>
#include <string>
#include <vector>

#include <weft/scenes/recording/recording.hpp>

namespace weft::scenes {

/// A scalar over time of a playback copy.
struct PlaybackMetric {
  std::string name;  ///< ends with its unit, as in "kinetic_energy_J"
  std::vector<RecordingReader::Sample> samples;
};

/// What of a recording goes into a copy that is only shown.
struct PlaybackCopyOptions {
  /// [m] by which rounding may move a coordinate; 1e-8 to 0.1 of the largest cloth.
  double position_error = 1e-5;
  std::vector<PlaybackMetric> metrics = {};      ///< beside those of the recording
  std::function<void(double)> on_progress = {};  ///< part that is done, 0 to 1
};

/// A copy of a recording for the playback page: the tables of a recording in which cloths have only positions, rounded, and
/// rigid bodies only poses, in single precision. docs/playback.md has the format. A SQLite file.
/// @throws InvalidArgument for an error out of its range; Error if the recording is damaged.
[[nodiscard]] std::string playback_copy(const RecordingReader& reader,
                                        const PlaybackCopyOptions& options);

}  // namespace weft::scenes
