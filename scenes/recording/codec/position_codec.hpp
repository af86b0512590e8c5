#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

namespace weft::scenes {

/// Name of the codec below, as in the column chunk.codec of a playback copy. docs/playback.md has the layout.
inline constexpr std::string_view kPositionCodecName = "positions+zstd";

/// Stands for a position that is not finite, or too far away for its step.
inline constexpr std::int32_t kNoPosition = INT32_MIN;

/// A frame of a playback copy.
struct RoundedFrame {
  /// Cloth after cloth all x, then all y, then all z, in steps.
  std::vector<std::int32_t> steps;
  /// Body after body: position x y z [m], orientation x y z w [-].
  std::vector<float> poses;
};

/// Whole number of steps [m] nearest to a coordinate [m], or kNoPosition.
[[nodiscard]] std::int32_t rounded_steps(double coordinate, double step);

/// Compresses frames that are alike in their sizes. cloth_nodes: number of nodes of every cloth. raw_bytes is what
/// decompressing the result gives.
struct CompressedFrames {
  std::vector<std::byte> data;
  std::size_t raw_bytes = 0;
};
[[nodiscard]] CompressedFrames compress_positions(const std::vector<RoundedFrame>& frames,
                                                  const std::vector<int>& cloth_nodes);

}  // namespace weft::scenes
