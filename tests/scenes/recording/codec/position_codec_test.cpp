#include <weft/scenes/recording/codec/position_codec.hpp>

#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include <gtest/gtest.h>
#include <zstd.h>

namespace weft::scenes {
namespace {

/// Undoes compress_positions() as docs/playback.md says.
std::vector<RoundedFrame> decompressed(const CompressedFrames& chunk, std::size_t num_frames,
                                       const std::vector<int>& cloth_nodes, std::size_t num_poses) {
  std::vector<std::uint8_t> bytes(chunk.raw_bytes);
  EXPECT_EQ(ZSTD_decompress(bytes.data(), bytes.size(), chunk.data.data(), chunk.data.size()),
            bytes.size());
  std::size_t per_frame = 0;
  for (const int nodes : cloth_nodes) per_frame += 3 * static_cast<std::size_t>(nodes);
  const std::size_t num_values = num_frames * per_frame;
  const std::size_t begin = 4 + 4 * num_poses * num_frames;
  EXPECT_EQ(bytes.size(), begin + 4 * num_values);
  std::vector<RoundedFrame> frames(num_frames);
  for (std::size_t f = 0; f < num_frames; ++f) {
    frames[f].poses.resize(num_poses);
    for (std::size_t k = 0; k < num_poses; ++k) {
      std::memcpy(&frames[f].poses[k], &bytes[4 + 4 * (num_poses * f + k)], sizeof(float));
    }
    std::vector<std::uint32_t> rest(per_frame);
    for (std::size_t i = 0; i < per_frame; ++i) {
      std::uint32_t zigzag = 0;
      for (std::size_t k = 0; k < 4; ++k) {
        zigzag |= std::uint32_t{bytes[begin + k * num_values + f * per_frame + i]} << (8 * k);
      }
      rest[i] = (zigzag >> 1U) ^ (0U - (zigzag & 1U));
    }
    std::size_t at = 0;
    for (const int nodes : cloth_nodes) {
      for (int axis = 0; axis < 3; ++axis, at += static_cast<std::size_t>(nodes)) {
        for (std::size_t i = at + 1; i < at + static_cast<std::size_t>(nodes); ++i) {
          if (f == 0 || bytes[1] == 1) rest[i] += rest[i - 1];
        }
      }
    }
    for (std::size_t i = 0; i < per_frame; ++i) {
      const auto before = [&](std::size_t n) {
        return static_cast<std::uint32_t>(frames[f - n].steps[i]);
      };
      if (f >= 2 && bytes[0] == 2) {
        rest[i] += 2 * before(1) - before(2);
      } else if (f >= 1) {
        rest[i] += before(1);
      }
      frames[f].steps.push_back(static_cast<std::int32_t>(rest[i]));
    }
  }
  return frames;
}

void expect_same(const std::vector<RoundedFrame>& frames, const std::vector<int>& cloth_nodes) {
  const CompressedFrames chunk = compress_positions(frames, cloth_nodes);
  const auto back = decompressed(chunk, frames.size(), cloth_nodes, frames.front().poses.size());
  for (std::size_t f = 0; f < frames.size(); ++f) {
    EXPECT_EQ(back[f].steps, frames[f].steps) << "frame " << f;
    EXPECT_EQ(back[f].poses, frames[f].poses) << "frame " << f;
  }
}

RoundedFrame frame_of(int num_values, const auto& value_at) {
  RoundedFrame frame;
  for (int i = 0; i < num_values; ++i) frame.steps.push_back(value_at(i));
  return frame;
}

TEST(PositionCodec, RoundsToTheNearestStepAndKnowsWhatIsNoPosition) {
  EXPECT_EQ(rounded_steps(0.0, 2e-5), 0);
  EXPECT_EQ(rounded_steps(-7.000012, 2e-5), -350001);
  EXPECT_LE(std::abs(rounded_steps(1.234567, 2e-5) * 2e-5 - 1.234567), 1e-5);
  EXPECT_EQ(rounded_steps(std::nan(""), 2e-5), kNoPosition);
  EXPECT_EQ(rounded_steps(-std::numeric_limits<double>::infinity(), 2e-5), kNoPosition);
  EXPECT_EQ(rounded_steps(1e30, 2e-5), kNoPosition) << "too far for 31 bits";
}

TEST(PositionCodec, EveryPredictionIsUndone) {
  const std::vector<int> nodes = {7, 4};
  // At rest, at a constant speed, and a wave along the cloth: each asks for another prediction.
  for (int kind = 0; kind < 3; ++kind) {
    std::vector<RoundedFrame> frames;
    for (int f = 0; f < 9; ++f) {
      frames.push_back(frame_of(33, [&](int i) {
        if (kind == 0) return 1000 * i;
        if (kind == 1) return 100 * i * i - 50 * i * f;
        return static_cast<int>(3000 * std::sin(0.9 * f * f));
      }));
      frames.back().poses = {0.5f * static_cast<float>(f), -1.0f, 3.25f};
    }
    expect_same(frames, nodes);
  }
}

TEST(PositionCodec, LargestNumbersAndMissingPositionsComeBack) {
  std::vector<RoundedFrame> frames;
  for (int f = 0; f < 4; ++f) {
    frames.push_back(frame_of(6, [&](int i) {
      if (i == 2 && f % 2 == 1) return kNoPosition;
      return (i + f) % 2 == 0 ? (1 << 30) : -(1 << 30);
    }));
  }
  expect_same(frames, {2});
}

TEST(PositionCodec, SmoothMotionTakesLessThanAByteForACoordinate) {
  constexpr int kNodes = 900;
  std::vector<RoundedFrame> frames;
  for (int f = 0; f < 40; ++f) {
    frames.push_back(frame_of(3 * kNodes, [&](int i) {
      return static_cast<int>(40'000 * std::sin(0.01 * i + 0.05 * f));
    }));
  }
  const CompressedFrames chunk = compress_positions(frames, {kNodes});
  EXPECT_LT(chunk.data.size(), std::size_t{40} * 3 * kNodes);
}

}  // namespace
}  // namespace weft::scenes
