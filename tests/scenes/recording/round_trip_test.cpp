#include <cstdio>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <weft/scenes/format/scene_file.hpp>
#include <weft/scenes/recording/recording.hpp>

#include "tests/scenes/recording/recording_samples.hpp"

namespace weft::scenes {
namespace {

using samples::make_scene;
using samples::make_state;
using samples::same_bits;
using samples::TemporaryFolder;
using samples::write_sample;

/// Not a multiple of a chunk, so that the last chunk is short.
constexpr int kNumFrames = 150;

class RecordingOf : public testing::TestWithParam<StoredPrecision> {};

TEST_P(RecordingOf, FramesComeBackBitForBitInAnyOrder) {
  const TemporaryFolder folder;
  const Scene scene = make_scene();
  const std::string hash = write_sample(folder / "a.weftrec", scene, GetParam(), kNumFrames);
  const RecordingReader reader(folder / "a.weftrec");
  ASSERT_EQ(reader.num_frames(), kNumFrames);
  EXPECT_EQ(reader.precision(), GetParam());
  EXPECT_TRUE(reader.finished());
  EXPECT_EQ(reader.content_hash(), hash);
  for (int i = 0; i < kNumFrames; ++i) {
    EXPECT_TRUE(same_bits(reader.frame(i), make_state(scene, i, GetParam()))) << i;
    const int jump = (i * 67) % kNumFrames;  // 67 and 150 have no common factor: visits every frame
    EXPECT_TRUE(same_bits(reader.frame(jump), make_state(scene, jump, GetParam()))) << jump;
    EXPECT_EQ(reader.frame_time(i), i / 60.0);
  }
  EXPECT_THROW((void)reader.frame(-1), InvalidArgument);
  EXPECT_THROW((void)reader.frame(kNumFrames), InvalidArgument);
  EXPECT_THROW((void)reader.frame_time(kNumFrames), InvalidArgument);
}

TEST_P(RecordingOf, ValuesThatAreNotFiniteComeBack) {
  const TemporaryFolder folder;
  const Scene scene = make_scene();
  SceneState state = make_state(scene, 0, GetParam());
  state.cloths[0].positions(1, 3) = std::numeric_limits<double>::quiet_NaN();
  state.cloths[1].velocities(2, 0) = -std::numeric_limits<double>::infinity();
  state.cloths[1].velocities(0, 0) = std::numeric_limits<float>::denorm_min();
  {
    RecordingWriter writer(folder / "a.weftrec", scene, {}, GetParam());
    writer.add_frame(state);
    writer.finish();
  }
  EXPECT_TRUE(same_bits(RecordingReader(folder / "a.weftrec").frame(0), state));
}

INSTANTIATE_TEST_SUITE_P(BothPrecisions, RecordingOf,
                         testing::Values(StoredPrecision::kFloat32, StoredPrecision::kFloat64));

TEST(Recording, KeepsSceneProvenanceBlowUpAndMetrics) {
  const TemporaryFolder folder;
  const Scene scene = make_scene();
  const Provenance provenance{{"engine", "fake"}, {"flags", "-O2 'quoted' \"too\""}, {"empty", ""}};
  {
    RecordingWriter writer(folder / "a.weftrec", scene, provenance, StoredPrecision::kFloat64);
    writer.add_metric("b_J", -0.0, std::numeric_limits<double>::quiet_NaN());
    writer.add_metric("a_m", 0.5, 1.0 / 3.0);
    writer.add_metric("a_m", 1.0, -0.0);
    writer.add_metric("a_m", 1.5, std::numeric_limits<double>::infinity());
    writer.add_metric("a_m", 2.0, 1e15);
    writer.set_blow_up(samples::kBlowUp);
    writer.finish();
  }
  const RecordingReader reader(folder / "a.weftrec");
  EXPECT_EQ(reader.provenance(), provenance);
  EXPECT_EQ(reader.scene_text(), write_scene(scene));
  EXPECT_EQ(reader.scene().cloths.at(1).name, "flag");
  ASSERT_TRUE(reader.blow_up().has_value());
  EXPECT_EQ(reader.blow_up()->step, samples::kBlowUp.step);
  EXPECT_EQ(reader.blow_up()->time, samples::kBlowUp.time);
  EXPECT_EQ(reader.blow_up()->body, samples::kBlowUp.body);
  EXPECT_EQ(reader.blow_up()->node, samples::kBlowUp.node);
  EXPECT_EQ(reader.blow_up()->reason, samples::kBlowUp.reason);
  EXPECT_THAT(reader.metric_names(), testing::ElementsAre("a_m", "b_J"));
  const auto values = reader.metric("a_m");
  ASSERT_EQ(values.size(), 4U);
  EXPECT_EQ(values[0].value, 1.0 / 3.0);
  EXPECT_EQ(values[2].value, std::numeric_limits<double>::infinity());
  EXPECT_EQ(values[3].value, 1e15);
  EXPECT_EQ(values[3].time, 2.0);
  EXPECT_TRUE(std::isnan(reader.metric("b_J").at(0).value));
  EXPECT_TRUE(reader.metric("none").empty());
}

TEST(Recording, IsOneFileWhenFinished) {
  const TemporaryFolder folder;
  write_sample(folder / "a.weftrec", make_scene(), StoredPrecision::kFloat32, kNumFrames);
  const RecordingReader reader(folder / "a.weftrec");
  (void)reader.frame(0);
  const std::filesystem::directory_iterator files(folder.path());
  EXPECT_EQ(std::distance(begin(files), end(files)), 1);
}

TEST(Recording, LeftUnfinishedIsReadableAndSaysSo) {
  const TemporaryFolder folder;
  const Scene scene = make_scene();
  {
    RecordingWriter writer(folder / "a.weftrec", scene, {}, StoredPrecision::kFloat64);
    writer.add_frame(make_state(scene, 0, StoredPrecision::kFloat64));
  }
  const RecordingReader reader(folder / "a.weftrec");
  EXPECT_FALSE(reader.finished());
  EXPECT_EQ(reader.num_frames(), 1);
  EXPECT_TRUE(same_bits(reader.frame(0), make_state(scene, 0, StoredPrecision::kFloat64)));
  EXPECT_FALSE(reader.content_hash().empty());
}

TEST(Recording, RefusesWrongFrames) {
  const TemporaryFolder folder;
  const Scene scene = make_scene();
  RecordingWriter writer(folder / "a.weftrec", scene, {}, StoredPrecision::kFloat64);
  const SceneState first = make_state(scene, 1, StoredPrecision::kFloat64);
  writer.add_frame(first);
  EXPECT_THROW(writer.add_frame(first), InvalidArgument);  // time does not grow
  SceneState state = make_state(scene, 2, StoredPrecision::kFloat64);
  state.time = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(writer.add_frame(state), InvalidArgument);
  state = make_state(scene, 2, StoredPrecision::kFloat64);
  state.cloths[0].velocities.conservativeResize(3, 4);
  EXPECT_THROW(writer.add_frame(state), InvalidArgument);
  state = make_state(scene, 2, StoredPrecision::kFloat64);
  std::swap(state.cloths[0].name, state.cloths[1].name);
  EXPECT_THROW(writer.add_frame(state), InvalidArgument);
  state = make_state(scene, 2, StoredPrecision::kFloat64);
  state.rigids.clear();
  EXPECT_THROW(writer.add_frame(state), InvalidArgument);
  EXPECT_THROW(writer.add_metric("", 0, 0), InvalidArgument);
  writer.finish();
  EXPECT_THROW(writer.add_frame(make_state(scene, 3, StoredPrecision::kFloat64)), Error);
  EXPECT_EQ(writer.finish(), RecordingReader(folder / "a.weftrec").content_hash());
  EXPECT_EQ(RecordingReader(folder / "a.weftrec").num_frames(), 1);
}

TEST(Recording, NeverOverwritesAFile) {
  const TemporaryFolder folder;
  write_sample(folder / "a.weftrec", make_scene(), StoredPrecision::kFloat32, 1);
  try {
    RecordingWriter writer(folder / "a.weftrec", make_scene(), {}, StoredPrecision::kFloat32);
    FAIL() << "overwritten";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("a.weftrec: exists already"));
  }
  EXPECT_EQ(RecordingReader(folder / "a.weftrec").num_frames(), 1);
}

TEST(Recording, AnImpossiblePathIsAnErrorAndLeavesNothing) {
  const TemporaryFolder folder;
  for (const char* name : {"no/such/folder/a.weftrec", "."}) {
    EXPECT_THROW(RecordingWriter(folder / name, make_scene(), {}, StoredPrecision::kFloat32),
                 Error);
  }
  EXPECT_THROW(
      RecordingWriter(folder / "b", make_scene(), {}, StoredPrecision::kFloat32, {.frames = 0}),
      InvalidArgument);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(Recording, OfAPathWithOddCharactersIsReadable) {
  const TemporaryFolder folder;
  for (const char* name :
       {":memory:", "file:a?mode=ro", "a%20b#c.weftrec", "\xc3\xa4 \xe6\x97\xa5.weftrec"}) {
    write_sample(folder / name, make_scene(), StoredPrecision::kFloat32, 1);
    EXPECT_EQ(RecordingReader(folder / name).num_frames(), 1) << name;
  }
}

/// 0.8: the sample moves every value in every frame, so only sign, exponent and leading digits can
/// be saved.
constexpr double kMaxSizeRatio = 0.8;

TEST(Recording, OfAThousandFramesIsSmallerThanItsNumbers) {
  const TemporaryFolder folder;
  constexpr int kFrames = 1000;
  constexpr int kNodes = 2 * 20 * 20;
  for (const auto& [precision, bytes] :
       {std::pair{StoredPrecision::kFloat32, 4}, std::pair{StoredPrecision::kFloat64, 8}}) {
    const auto path = folder / ("a" + std::to_string(bytes));
    write_sample(path, make_scene(20), precision, kFrames);
    const double raw = 1.0 * kFrames * (kNodes * 6 + 13) * bytes;
    const double ratio = static_cast<double>(std::filesystem::file_size(path)) / raw;
    std::printf("float%d: %.1f MB of numbers, file is %.3f of it\n", 8 * bytes, raw / 1e6, ratio);
    EXPECT_LT(ratio, kMaxSizeRatio);
  }
}

}  // namespace
}  // namespace weft::scenes
