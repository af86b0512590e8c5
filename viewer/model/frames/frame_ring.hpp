#pragma once

// Tested by tests/viewer/model/frames/frame_ring_test.cpp.

#include <cstddef>
#include <deque>

#include <weft/viewer/model/frames/snapshot.hpp>

namespace weft::viewer {

/// The frames of a live run that are kept for looking back: the latest ones, as many as fit.
class FrameRing {
 public:
  static constexpr std::size_t kMaxFrames = 5000;
  static constexpr std::size_t kMaxBytes = std::size_t{512} * 1024 * 1024;

  explicit FrameRing(std::size_t max_frames = kMaxFrames, std::size_t max_bytes = kMaxBytes);

  /// Adds the newest frame; the oldest ones go where there is no room, but never the newest.
  void add(SnapshotPtr frame);
  void clear();
  /// The run has gone back: frames after a step never were.
  void drop_after(int step);

  [[nodiscard]] std::size_t size() const { return frames_.size(); }
  [[nodiscard]] SnapshotPtr at(std::size_t index) const { return frames_.at(index); }
  [[nodiscard]] const std::deque<SnapshotPtr>& frames() const { return frames_; }

 private:
  std::size_t max_frames_;
  std::size_t max_bytes_;
  std::size_t bytes_ = 0;
  std::deque<SnapshotPtr> frames_;
};

}  // namespace weft::viewer
