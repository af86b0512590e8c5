#include <weft/scenes/recording/verify.hpp>

#include <sqlite3.h>

#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/scenes/recording/recording_samples.hpp"

namespace weft::scenes {
namespace {

using samples::make_scene;
using samples::make_state;
using samples::TemporaryFolder;
using samples::write_sample;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr auto kPrecision = StoredPrecision::kFloat32;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

void run_sql(const std::filesystem::path& path, const char* sql) {
  sqlite3* connection = nullptr;
  ASSERT_EQ(sqlite3_open(path.c_str(), &connection), SQLITE_OK);
  EXPECT_EQ(sqlite3_exec(connection, sql, nullptr, nullptr, nullptr), SQLITE_OK)
      << sqlite3_errmsg(connection);
  sqlite3_close(connection);
}

/// A recording of twelve frames in three chunks, changed with SQL.
Verification verify_after(const char* sql) {
  const TemporaryFolder folder;
  write_sample(folder / "a", make_scene(), kPrecision, 12, {.frames = 4});
  run_sql(folder / "a", sql);
  return verify_recording(RecordingReader(folder / "a"));
}

std::vector<std::pair<int, int>> readable(const Verification& verification) {
  std::vector<std::pair<int, int>> ranges;
  for (const FrameRange& range : verification.readable) {
    ranges.emplace_back(range.first, range.last);
  }
  return ranges;
}

TEST(Verify, AWholeRecordingIsSound) {
  const Verification verification = verify_after("");
  EXPECT_TRUE(verification.is_sound());
  EXPECT_EQ(verification.num_frames, 12);
  EXPECT_EQ(verification.num_readable, 12);
  EXPECT_THAT(readable(verification), ElementsAre(std::pair(0, 11)));
  EXPECT_EQ(verification.num_non_finite, 0);
}

TEST(Verify, FindsTheFramesAroundADamagedChunk) {
  const Verification verification =
      verify_after("UPDATE chunk SET data = zeroblob(9) WHERE id = 1");
  EXPECT_FALSE(verification.is_sound());
  EXPECT_EQ(verification.num_frames, 12);
  EXPECT_EQ(verification.num_readable, 8);
  EXPECT_THAT(readable(verification), ElementsAre(std::pair(0, 3), std::pair(8, 11)));
  EXPECT_THAT(verification.faults,
              ElementsAre(HasSubstr("a: data does not have its hash (chunk 1, frames 4 to 7)")));
}

TEST(Verify, GoesOnAfterEachFault) {
  const Verification verification = verify_after(
      "UPDATE chunk SET data = zeroblob(9) WHERE id <> 1; UPDATE metric SET value = 1");
  EXPECT_THAT(readable(verification), ElementsAre(std::pair(4, 7)));
  EXPECT_THAT(verification.faults,
              ElementsAre(HasSubstr("frames 0 to 3"), HasSubstr("frames 8 to 11"),
                          HasSubstr("table metric does not have its hash")));
}

TEST(Verify, FindsTheFirstValueThatIsNotFinite) {
  struct Sample {
    std::function<void(SceneState&)> spoil;
    std::string body;
    std::string quantity;
    std::optional<int> node;
  };
  const std::vector<Sample> samples = {
      {[](SceneState& s) { s.cloths[1].positions(2, 7) = kNaN; }, "flag", "position", 7},
      {[](SceneState& s) { s.cloths[0].velocities(0, 3) = kInfinity; }, "towel", "velocity", 3},
      {[](SceneState& s) { s.rigids[0].position[1] = -kInfinity; }, "ball", "position", {}},
      {[](SceneState& s) { s.rigids[0].orientation.w() = kNaN; }, "ball", "orientation", {}},
      {[](SceneState& s) { s.rigids[0].velocity[0] = kNaN; }, "ball", "velocity", {}},
      {[](SceneState& s) { s.rigids[0].angular_velocity[2] = kNaN; },
       "ball",
       "angular velocity",
       {}},
  };
  for (const Sample& sample : samples) {
    const TemporaryFolder folder;
    {
      RecordingWriter writer(folder / "a", make_scene(), {}, kPrecision);
      for (int frame = 0; frame < 6; ++frame) {
        SceneState state = make_state(make_scene(), frame, kPrecision);
        if (frame >= 3) sample.spoil(state);
        writer.add_frame(state);
      }
      writer.finish();
    }
    const Verification verification = verify_recording(RecordingReader(folder / "a"));
    EXPECT_FALSE(verification.is_sound());
    EXPECT_TRUE(verification.faults.empty());
    EXPECT_EQ(verification.num_readable, 6);
    EXPECT_EQ(verification.num_non_finite, 3);
    const NonFiniteValue& first = verification.first_non_finite.value();
    EXPECT_EQ(first.frame, 3);
    EXPECT_EQ(first.time, 0.05);
    EXPECT_EQ(first.body, sample.body);
    EXPECT_EQ(first.quantity, sample.quantity);
    EXPECT_EQ(first.node, sample.node);
  }
}

TEST(Verify, APartialRecordingHasItsCommittedFrames) {
  const TemporaryFolder folder;
  RecordingWriter writer(folder / "a", make_scene(), {}, kPrecision, {.frames = 4});
  for (int frame = 0; frame < 7; ++frame) {
    writer.add_frame(make_state(make_scene(), frame, kPrecision));
  }
  const RecordingReader reader(folder / "a");
  const Verification verification = verify_recording(reader);
  EXPECT_FALSE(reader.finished());
  EXPECT_TRUE(verification.is_sound());
  EXPECT_EQ(verification.num_frames, 4);
  EXPECT_EQ(verification.num_readable, 4);
}

TEST(Verify, TellsHowFarItIs) {
  const TemporaryFolder folder;
  write_sample(folder / "a", make_scene(), kPrecision, 4);
  std::vector<double> parts;
  (void)verify_recording(RecordingReader(folder / "a"),
                         [&](double part) { parts.push_back(part); });
  EXPECT_THAT(parts, ElementsAre(0.25, 0.5, 0.75, 1.0));
}

}  // namespace
}  // namespace weft::scenes
