#pragma once

#include <optional>
#include <vector>

#include <weft/scenes/recording/recording.hpp>

namespace weft::app {

/// How a film is to be shown.
struct FilmRequest {
  std::optional<double> frame_rate = {};  ///< [1/s] of the film; none: that of the recording
  double largest_default_rate = 60.0;     ///< [1/s] without frame_rate
  double speed = 1.0;  ///< seconds of the recording for each second of the film, > 0
};

/// The frames of a film in the order in which they are shown.
struct FilmTimes {
  std::vector<int> frames;   ///< of the recording; may be there several times, or be left out
  double frame_rate = 25.0;  ///< [1/s]
};

/// A film of these frames of a recording, ascending, from the first to the last: for each picture the frame nearest to its time. Throws InvalidArgument for values out of range.
[[nodiscard]] FilmTimes frames_of_film(const scenes::RecordingReader& reader,
                                       const std::vector<int>& frames, const FilmRequest& request);

/// A film of a single frame. duration: [s], > 0.
[[nodiscard]] FilmTimes still_film(int frame, double duration, const FilmRequest& request);

}  // namespace weft::app
