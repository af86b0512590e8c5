#include <weft/scenes/recording/frame_times.hpp>

#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/scenes/recording/recording_samples.hpp"

namespace weft::scenes {
namespace {

using samples::make_scene;
using samples::make_state;
using samples::TemporaryFolder;
using testing::ElementsAre;

constexpr double kFrameTimesInfinity = std::numeric_limits<double>::infinity();

/// A recording with frames at these times [s].
void write_times(const std::filesystem::path& path, const std::vector<double>& times) {
  const Scene scene = make_scene(2);
  RecordingWriter writer(path, scene, {}, StoredPrecision::kFloat32);
  for (const double time : times) {
    SceneState state = make_state(scene, 0, StoredPrecision::kFloat32);
    state.time = time;
    writer.add_frame(state);
  }
  writer.finish();
}

std::vector<std::pair<int, int>> common(const RecordingReader& a, const RecordingReader& b) {
  std::vector<std::pair<int, int>> pairs;
  for (const CommonFrame& frame : common_frames(a, b)) pairs.emplace_back(frame.a, frame.b);
  return pairs;
}

TEST(FrameTimes, ATimeMayBeWrongByAThousandthOfTheSmallestSpacing) {
  const TemporaryFolder folder;
  write_times(folder / "a", {0.0, 0.1, 0.14, 0.2});
  EXPECT_NEAR(time_tolerance(RecordingReader(folder / "a")), 4e-5, 1e-15);
}

TEST(FrameTimes, WithoutASpacingThatOfTheSceneCounts) {
  const TemporaryFolder folder;
  write_times(folder / "a", {0.25});
  const RecordingReader reader(folder / "a");
  EXPECT_EQ(time_tolerance(reader), 1e-3 * reader.scene().world.frame_interval);
}

TEST(FrameTimes, ARangeHasItsEndsThoughTheyAreRounded) {
  const TemporaryFolder folder;
  const float step = 0.1F;
  write_times(folder / "a",
              {0.0, double{step}, 2 * double{step}, 3 * double{step}, 4 * double{step}});
  const RecordingReader reader(folder / "a");
  EXPECT_THAT(frames_between(reader, 0.1, 0.3), ElementsAre(1, 2, 3));
  EXPECT_THAT(frames_between(reader, 0.10005, 0.29995), ElementsAre(1, 2, 3));
  EXPECT_THAT(frames_between(reader, 0.102, 0.298), ElementsAre(2));
  EXPECT_THAT(frames_between(reader, -kFrameTimesInfinity, 0.1), ElementsAre(0, 1));
  EXPECT_THAT(frames_between(reader, 0.35, kFrameTimesInfinity), ElementsAre(4));
  EXPECT_THAT(frames_between(reader, 0.41, kFrameTimesInfinity), ElementsAre());
  EXPECT_THAT(frames_between(reader, 0.3, 0.1), ElementsAre());
}

TEST(FrameTimes, FramesOfDifferentIntervalsMeetAtTheirCommonTimes) {
  const TemporaryFolder folder;
  write_times(folder / "a", {0.0, 0.1, 0.2, 0.3, 0.4});
  write_times(folder / "b", {0.1 + 1e-6, 0.15, 0.2 - 1e-6, 0.25, 0.3, 0.35});
  const RecordingReader a(folder / "a");
  const RecordingReader b(folder / "b");
  EXPECT_THAT(common(a, b), ElementsAre(std::pair(1, 0), std::pair(2, 2), std::pair(3, 4)));
  EXPECT_THAT(common(b, a), ElementsAre(std::pair(0, 1), std::pair(2, 2), std::pair(4, 3)));
}

TEST(FrameTimes, TimesThatOnlyComeNearAreNotCommon) {
  const TemporaryFolder folder;
  write_times(folder / "a", {0.0, 0.1, 0.2});
  write_times(folder / "b", {0.001, 0.101, 0.201});
  EXPECT_THAT(common(RecordingReader(folder / "a"), RecordingReader(folder / "b")), ElementsAre());
}

}  // namespace
}  // namespace weft::scenes
