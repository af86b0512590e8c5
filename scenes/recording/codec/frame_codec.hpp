#pragma once

// Tested by tests/scenes/recording/round_trip_test.cpp, tests/scenes/recording/damage_test.cpp.

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <weft/scenes/recording/recording.hpp>

namespace weft::scenes {

/// One body of a recording.
struct RecordedBody {
  std::string name;
  bool is_cloth = false;  ///< otherwise rigid
  int num_nodes = 1;      ///< 1 for rigid bodies
};

/// The bodies of a scene in the order of a frame: cloths, then rigid bodies.
[[nodiscard]] std::vector<RecordedBody> recorded_bodies(const Scene& scene);

/// Turns states into bytes and back. docs/recording_format.md has the layout.
class FrameCodec {
 public:
  FrameCodec(std::vector<RecordedBody> bodies, StoredPrecision precision);

  [[nodiscard]] const std::vector<RecordedBody>& bodies() const { return bodies_; }
  [[nodiscard]] StoredPrecision precision() const { return precision_; }
  [[nodiscard]] std::size_t scalar_bytes() const;
  [[nodiscard]] std::size_t frame_bytes() const { return frame_bytes_; }

  /// A cloth that has torn has another number of nodes from the next frame on.
  void set_num_nodes(std::size_t body, int num_nodes);

  /// Throws InvalidArgument if the state has not the bodies of this recording.
  void check(const SceneState& state) const;
  /// Appends frame_bytes() bytes; the time is not among them.
  void encode(const SceneState& state, std::vector<std::byte>& out) const;
  /// The inverse; bytes must have frame_bytes() elements. The time is left at zero.
  [[nodiscard]] SceneState decode(std::span<const std::byte> bytes) const;

 private:
  [[nodiscard]] std::size_t bytes_of(const RecordedBody& body) const;

  std::vector<RecordedBody> bodies_;
  StoredPrecision precision_;
  std::size_t frame_bytes_ = 0;
};

}  // namespace weft::scenes
