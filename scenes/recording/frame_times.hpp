#pragma once

#include <vector>

#include <weft/scenes/recording/recording.hpp>

namespace weft::scenes {

/// Engines add up their times step by step, Bullet steps that are rounded to single precision: what
/// is one moment for a person differs by rounding between two recordings, and from the number that
/// the person writes. This is how far such times may be apart [s]: a thousandth of the smallest
/// distance of two frames, or of the scene's frame interval if there are not two.
[[nodiscard]] double time_tolerance(const RecordingReader& reader);

/// The frames from a time to another one, both included within time_tolerance() [s]. Infinite times
/// have no end.
[[nodiscard]] std::vector<int> frames_between(const RecordingReader& reader, double from,
                                              double to);

/// A frame in each of two recordings, both of the same time.
struct CommonFrame {
  int a = 0;
  int b = 0;
};

/// All frames of the same time, within the smaller time_tolerance(), in the order of time.
[[nodiscard]] std::vector<CommonFrame> common_frames(const RecordingReader& a,
                                                     const RecordingReader& b);

}  // namespace weft::scenes
