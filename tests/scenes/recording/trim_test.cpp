#include <weft/scenes/recording/trim.hpp>

#include <sqlite3.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/scenes/recording/recording_samples.hpp"

namespace weft::scenes {
namespace {

using samples::kBlowUp;
using samples::make_scene;
using samples::make_state;
using samples::same_bits;
using samples::TemporaryFolder;
using samples::write_sample;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::SizeIs;

constexpr auto kTrimPrecision = StoredPrecision::kFloat32;
constexpr double kInterval = 1.0 / 60;  ///< of the sample's frames [s]

/// Copies a range of a recording into another one and gives that one's content hash.
std::string trim(const std::filesystem::path& from, const std::filesystem::path& to,
                 const TrimRange& range) {
  const RecordingReader reader(from);
  RecordingWriter writer(to, reader.scene(), trimmed_provenance(reader, range), reader.precision());
  copy_range(reader, range, writer);
  return writer.finish();
}

std::string message_of(const RecordingReader& reader, const TrimRange& range) {
  try {
    (void)frames_to_keep(reader, range);
  } catch (const InvalidArgument& error) {
    return error.what();
  }
  return "nothing was thrown";
}

TEST(Trim, KeepsTimesAndBitsOfTheRange) {
  const TemporaryFolder folder;
  write_sample(folder / "a", make_scene(), kTrimPrecision, 12, {.frames = 5});
  trim(folder / "a", folder / "b", {.from = 3 * kInterval, .to = 9 * kInterval, .every = 2});
  const RecordingReader a(folder / "a");
  const RecordingReader b(folder / "b");
  ASSERT_EQ(b.num_frames(), 4);
  for (int frame = 0; frame < 4; ++frame) {
    EXPECT_TRUE(same_bits(b.frame(frame), a.frame(3 + 2 * frame))) << frame;
  }
  EXPECT_TRUE(b.finished());
  EXPECT_EQ(b.precision(), kTrimPrecision);
  EXPECT_EQ(b.scene_text(), a.scene_text());
}

TEST(Trim, TheWholeHasTheContentOfTheRecording) {
  const TemporaryFolder folder;
  const std::string hash = write_sample(folder / "a", make_scene(), kTrimPrecision, 7);
  EXPECT_EQ(trim(folder / "a", folder / "b", {}), hash);
  EXPECT_EQ(RecordingReader(folder / "b").blow_up()->reason, kBlowUp.reason);
}

TEST(Trim, MetricsAndABlowUpComeAlongIfTheyAreInTheRange) {
  const TemporaryFolder folder;
  write_sample(folder / "a", make_scene(), kTrimPrecision, 30);  // blows up at 0.41 s
  trim(folder / "a", folder / "before", {.from = 10 * kInterval, .to = 0.4});
  const RecordingReader before(folder / "before");
  EXPECT_FALSE(before.blow_up());
  EXPECT_THAT(before.metric("height_m"), SizeIs(15));  // of frames 10 to 24
  EXPECT_EQ(before.metric("height_m").front().time, 10 * kInterval);
  EXPECT_EQ(before.metric("height_m").front().value, 1.0);
  trim(folder / "a", folder / "after", {.from = 0.3});
  EXPECT_EQ(RecordingReader(folder / "after").blow_up()->node, kBlowUp.node);
  trim(folder / "a", folder / "late", {.from = 0.45});
  EXPECT_FALSE(RecordingReader(folder / "late").blow_up());
}

TEST(Trim, TellsWhatItIsAPartOf) {
  const TemporaryFolder folder;
  write_sample(folder / "a", make_scene(), kTrimPrecision, 12, {}, {{"engine", "reference"}});
  const RecordingReader a(folder / "a");
  const Provenance part = trimmed_provenance(a, {.from = 2.5 * kInterval, .every = 4});
  EXPECT_EQ(part.at("trimmed"), "frames 3 to 11 of 12, counted from 0, one in 4");
  EXPECT_EQ(part.at("engine"), "reference");
  {
    RecordingWriter writer(folder / "b", make_scene(), {}, kTrimPrecision);
    writer.add_frame(make_state(make_scene(), 0, kTrimPrecision));
  }
  EXPECT_EQ(trimmed_provenance(RecordingReader(folder / "b"), {}).at("trimmed"),
            "frames 0 to 0 of 1 of a partial recording, counted from 0");
}

TEST(Trim, RefusesARangeWithoutFrames) {
  const TemporaryFolder folder;
  write_sample(folder / "a", make_scene(), kTrimPrecision, 7);
  const RecordingReader reader(folder / "a");
  EXPECT_EQ(message_of(reader, {.from = 2, .to = 3}),
            "has no frame from 2 s to 3 s, expected a time from its 7 frames, t = 0 s to 0.1 s");
  EXPECT_THAT(message_of(reader, {.to = -1}), HasSubstr("has no frame from the beginning to -1 s"));
  EXPECT_THAT(message_of(reader, {.from = 1}), HasSubstr("has no frame from 1 s to the end"));
  EXPECT_THAT(message_of(reader, {.every = 0}), HasSubstr("every = 0, expected >= 1"));
  write_sample(folder / "b", make_scene(), kTrimPrecision, 0);
  EXPECT_EQ(message_of(RecordingReader(folder / "b"), {}), "has no frame to keep");
}

TEST(Trim, SavesWhatIsBesideADamagedChunk) {
  const TemporaryFolder folder;
  write_sample(folder / "a", make_scene(), kTrimPrecision, 12, {.frames = 4});
  sqlite3* connection = nullptr;
  ASSERT_EQ(sqlite3_open((folder / "a").c_str(), &connection), SQLITE_OK);
  EXPECT_EQ(sqlite3_exec(connection, "UPDATE chunk SET data = zeroblob(9) WHERE id = 1", nullptr,
                         nullptr, nullptr),
            SQLITE_OK);
  sqlite3_close(connection);
  EXPECT_THROW(trim(folder / "a", folder / "whole", {}), Error);
  trim(folder / "a", folder / "b", {.from = 8 * kInterval});
  const RecordingReader saved(folder / "b");
  ASSERT_EQ(saved.num_frames(), 4);
  EXPECT_TRUE(same_bits(saved.frame(3), make_state(make_scene(), 11, kTrimPrecision)));
}

TEST(Trim, TornClothKeepsItsTopologies) {
  const TemporaryFolder folder;
  Scene scene = make_scene();
  scene.cloths[0].tear.emplace();
  const Triangles whole = make_mesh(scene.cloths[0]).triangles;
  const auto torn = [&](int num_new) {
    ClothTopology topology{whole, {}};
    for (int i = 0; i < num_new; ++i) {
      topology.origins.push_back(topology.triangles(0, 3 * i));
      topology.triangles(0, 3 * i) = 25 + i;
    }
    return std::make_shared<const ClothTopology>(std::move(topology));
  };
  const std::vector<std::shared_ptr<const ClothTopology>> topologies = {nullptr, torn(1), torn(2),
                                                                        torn(3)};
  {
    RecordingWriter writer(folder / "a", scene, {}, kTrimPrecision);
    for (int frame = 0; frame < 8; ++frame) {  // tears more in frames 2, 4 and 6
      SceneState state = make_state(scene, frame, kTrimPrecision);
      ClothState& cloth = state.cloths[0];
      cloth.topology = topologies[static_cast<std::size_t>(frame / 2)];
      const Eigen::Index added = frame / 2;
      cloth.positions.conservativeResize(3, 25 + added);
      cloth.velocities.conservativeResize(3, 25 + added);
      cloth.positions.rightCols(added).setConstant(0.5 * frame);
      cloth.velocities.rightCols(added).setConstant(0.25);
      writer.add_frame(state);
    }
    writer.finish();
  }
  trim(folder / "a", folder / "b", {.from = 3 * kInterval, .every = 4});  // frames 3 and 7
  const RecordingReader a(folder / "a");
  const RecordingReader b(folder / "b");
  ASSERT_EQ(b.num_frames(), 2);
  for (int frame = 0; frame < 2; ++frame) {
    const SceneState expected = a.frame(3 + 4 * frame);
    const SceneState found = b.frame(frame);
    EXPECT_TRUE(same_bits(found, expected)) << frame;
    EXPECT_EQ(found.cloths[0].topology->triangles, expected.cloths[0].topology->triangles);
    EXPECT_EQ(found.cloths[0].topology->origins, expected.cloths[0].topology->origins);
  }
  EXPECT_THAT(b.frame(1).cloths[0].topology->origins, SizeIs(3));
}

}  // namespace
}  // namespace weft::scenes
