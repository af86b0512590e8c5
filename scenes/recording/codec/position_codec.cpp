#include <weft/scenes/recording/codec/position_codec.hpp>

#include <array>
#include <bit>
#include <cmath>

#include <fmt/core.h>
#include <zstd.h>

#include <weft/core/error.hpp>
#include <weft/scenes/recording/codec/little_endian.hpp>

namespace weft::scenes {
namespace {

/// To compare the ways of predicting; then for the best one.
constexpr int kTrialLevel = 1;
constexpr int kFinalLevel = 9;

constexpr std::size_t kHeaderBytes = 4;
constexpr std::size_t kPlanes = sizeof(std::uint32_t);

/// How a step is predicted; what is left is small and compresses well.
struct Prediction {
  std::uint8_t order;      ///< from one frame before, or from two along a straight line
  std::uint8_t neighbors;  ///< 1: then by what was left at the node before
};

// Unsigned arithmetic: it wraps around, so that every prediction can be undone, also at kNoPosition.
std::uint32_t from_time(const std::vector<RoundedFrame>& frames, std::size_t frame, std::size_t i,
                        int order) {
  const auto at = [&](std::size_t f) { return static_cast<std::uint32_t>(frames[f].steps[i]); };
  if (frame == 0) return at(0);
  if (frame == 1 || order == 1) return at(frame) - at(frame - 1);
  return at(frame) - 2U * at(frame - 1) + at(frame - 2);
}

/// Small numbers of both signs become small numbers.
std::uint32_t zigzag(std::uint32_t value) {
  return (value << 1U) ^ (0U - (value >> 31U));
}

std::vector<std::byte> plain_bytes(const std::vector<RoundedFrame>& frames,
                                   const std::vector<int>& cloth_nodes, Prediction prediction) {
  const std::size_t num_values = frames.size() * frames.front().steps.size();
  const std::size_t num_poses = frames.size() * frames.front().poses.size();
  std::vector<std::byte> bytes(kHeaderBytes + sizeof(float) * num_poses + kPlanes * num_values);
  bytes[0] = std::byte{prediction.order};
  bytes[1] = std::byte{prediction.neighbors};
  std::byte* to = bytes.data() + kHeaderBytes;
  for (const RoundedFrame& frame : frames) {
    for (const float value : frame.poses) {
      store_little_endian(std::bit_cast<std::uint32_t>(value), to);
      to += sizeof(float);
    }
  }
  std::size_t value_index = 0;
  for (std::size_t f = 0; f < frames.size(); ++f) {
    // The first frame of a chunk has no other before it.
    const bool by_neighbors = f == 0 || prediction.neighbors != 0;
    std::size_t i = 0;
    for (const int nodes : cloth_nodes) {
      for (int axis = 0; axis < 3; ++axis) {
        std::uint32_t before = 0;
        for (int node = 0; node < nodes; ++node, ++i, ++value_index) {
          const std::uint32_t left = from_time(frames, f, i, prediction.order);
          const std::uint32_t rest = zigzag(by_neighbors ? left - before : left);
          before = left;
          for (std::size_t k = 0; k < kPlanes; ++k) {
            to[k * num_values + value_index] = std::byte{static_cast<std::uint8_t>(rest >> 8 * k)};
          }
        }
      }
    }
  }
  return bytes;
}

std::vector<std::byte> compressed(const std::vector<std::byte>& bytes, int level) {
  std::vector<std::byte> data(ZSTD_compressBound(bytes.size()));
  const std::size_t size =
      ZSTD_compress(data.data(), data.size(), bytes.data(), bytes.size(), level);
  if (ZSTD_isError(size) != 0) {
    throw Error(fmt::format("cannot compress: {}", ZSTD_getErrorName(size)));
  }
  data.resize(size);
  return data;
}

}  // namespace

std::int32_t rounded_steps(double coordinate, double step) {
  constexpr double kLargest = 1 << 30;
  const double steps = std::round(coordinate / step);
  return std::abs(steps) <= kLargest ? static_cast<std::int32_t>(steps) : kNoPosition;
}

CompressedFrames compress_positions(const std::vector<RoundedFrame>& frames,
                                    const std::vector<int>& cloth_nodes) {
  constexpr std::array<Prediction, 4> kPredictions = {{{1, 0}, {1, 1}, {2, 0}, {2, 1}}};
  std::vector<std::byte> best;
  std::size_t smallest = SIZE_MAX;
  for (const Prediction prediction : kPredictions) {
    std::vector<std::byte> bytes = plain_bytes(frames, cloth_nodes, prediction);
    const std::size_t size = compressed(bytes, kTrialLevel).size();
    if (size >= smallest) continue;
    smallest = size;
    best = std::move(bytes);
  }
  return {compressed(best, kFinalLevel), best.size()};
}

}  // namespace weft::scenes
