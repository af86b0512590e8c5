#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <weft/scenes/recording/recording.hpp>

namespace weft::scenes {

/// Frames one after another, both included.
struct FrameRange {
  int first = 0;
  int last = 0;
};

/// The first value of a recording that is not a finite number.
struct NonFiniteValue {
  int frame = 0;
  double time = 0.0;  ///< [s]
  std::string body;
  std::optional<int> node = {};  ///< of a cloth
  std::string quantity;          ///< "position", "velocity", "orientation", "angular velocity"
};

/// What is right in a recording that can be opened, and what is not.
struct Verification {
  int num_frames = 0;    ///< committed
  int num_readable = 0;  ///< of them
  std::vector<FrameRange> readable;
  int num_non_finite = 0;  ///< readable frames with a value that is not finite
  std::optional<NonFiniteValue> first_non_finite;
  std::vector<std::string> faults;  ///< what the reader refuses, a line each that names the file

  [[nodiscard]] bool is_sound() const { return faults.empty() && num_non_finite == 0; }
};

/// Reads all of a recording: the scene and its bodies, every frame with the hash of its chunk and
/// its topologies, the metrics, the content hash. Goes on after a fault. progress, if any, is
/// called after each frame with the part that is done, 0 to 1.
[[nodiscard]] Verification verify_recording(const RecordingReader& reader,
                                            const std::function<void(double)>& progress = {});

}  // namespace weft::scenes
