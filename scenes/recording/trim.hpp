#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <vector>

#include <weft/scenes/recording/recording.hpp>
#include <weft/scenes/recording/rounding.hpp>

namespace weft::scenes {

/// What of a recording to keep.
struct TrimRange {
  double from = -std::numeric_limits<double>::infinity();  ///< [s], included
  double to = std::numeric_limits<double>::infinity();     ///< [s], included
  int every = 1;  ///< keeps the first frame, and then every so many, >= 1
  std::optional<RoundingBounds> rounding = std::nullopt;  ///< none: every bit
};

/// The frames of a range, see frames_between().
/// @throws InvalidArgument if there is none, with the times that the recording has; for every < 1.
[[nodiscard]] std::vector<int> frames_to_keep(const RecordingReader& reader,
                                              const TrimRange& range);

/// Writes the frames that frames_to_keep() gives, with their own times and bits, unless they are to be rounded, and their
/// marks, then the metrics and notes of the range and the blow-up if it is in the range. The writer must be of the same scene and
/// precision, and without frames. progress, if any, is called after each frame with the part that
/// is done, 0 to 1.
/// @throws Error if one of the frames is damaged; damage elsewhere does not matter.
void copy_range(const RecordingReader& reader, const TrimRange& range, RecordingWriter& writer,
                const std::function<void(double)>& progress = {});

/// The provenance of the recording and, as "trimmed", which of its frames were kept, and how they were rounded.
[[nodiscard]] Provenance trimmed_provenance(const RecordingReader& reader, const TrimRange& range);

}  // namespace weft::scenes
