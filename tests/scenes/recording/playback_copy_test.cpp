#include <weft/scenes/recording/playback_copy.hpp>

#include <string>

#include <gtest/gtest.h>
#include <sqlite3.h>

#include <weft/core/error.hpp>

#include "tests/scenes/recording/recording_samples.hpp"

namespace weft::scenes {
namespace {

using samples::TemporaryFolder;

/// First column of the first row, as a text.
std::string query(std::string bytes, const std::string& sql) {
  sqlite3* database = nullptr;
  EXPECT_EQ(sqlite3_open(":memory:", &database), SQLITE_OK);
  EXPECT_EQ(
      sqlite3_deserialize(database, "main", reinterpret_cast<unsigned char*>(bytes.data()),
                          static_cast<sqlite3_int64>(bytes.size()),
                          static_cast<sqlite3_int64>(bytes.size()), SQLITE_DESERIALIZE_READONLY),
      SQLITE_OK);
  sqlite3_stmt* statement = nullptr;
  EXPECT_EQ(sqlite3_prepare_v2(database, sql.c_str(), -1, &statement, nullptr), SQLITE_OK) << sql;
  std::string text = "no row";
  if (sqlite3_step(statement) == SQLITE_ROW) {
    const auto* value = sqlite3_column_text(statement, 0);
    text = value == nullptr ? "null" : reinterpret_cast<const char*>(value);
  }
  sqlite3_finalize(statement);
  sqlite3_close(database);
  return text;
}

class PlaybackCopy : public testing::Test {
 protected:
  std::filesystem::path write(int num_frames) {
    std::filesystem::path file = folder_ / "sample.weftrec";
    samples::write_sample(file, samples::make_scene(), StoredPrecision::kFloat64, num_frames, {},
                          {{"engine", "reference"}});
    return file;
  }
  TemporaryFolder folder_;
};

TEST_F(PlaybackCopy, HasEveryFrameMetricAndTheBlowUp) {
  const RecordingReader reader(write(150));
  PlaybackCopyOptions options;
  options.metrics = {{"cloth_kinetic_energy_J", {{0.0, 1.5}}}};
  const std::string copy = playback_copy(reader, options);
  EXPECT_EQ(query(copy, "SELECT count(*) FROM frame"), "150");
  EXPECT_EQ(query(copy, "SELECT sum(num_frames) FROM chunk"), "150");
  EXPECT_EQ(query(copy, "SELECT count(*) FROM metric WHERE name = 'height_m'"), "150");
  EXPECT_EQ(query(copy, "SELECT value FROM metric WHERE name = 'cloth_kinetic_energy_J'"), "1.5");
  EXPECT_EQ(query(copy, "SELECT reason FROM event"), "position is not finite");
  EXPECT_EQ(query(copy, "SELECT text FROM scene"), reader.scene_text());
  EXPECT_EQ(query(copy, "SELECT value FROM meta WHERE key = 'content_hash'"),
            reader.content_hash());
  EXPECT_EQ(query(copy, "SELECT value FROM meta WHERE key = 'provenance.engine'"), "reference");
  EXPECT_EQ(query(copy, "SELECT value FROM meta WHERE key = 'position_error_m'"), "1e-05");
}

TEST_F(PlaybackCopy, IsTheSameBytesEveryTimeAndNoRecording) {
  const std::filesystem::path file = write(20);
  const RecordingReader reader(file);
  const std::string copy = playback_copy(reader, {});
  EXPECT_EQ(copy, playback_copy(reader, {}));
  EXPECT_NE(query(copy, "PRAGMA application_id"), std::to_string(0x57454654));
}

TEST_F(PlaybackCopy, RefusesAnErrorThatIsNoLengthOrOutOfRange) {
  const RecordingReader reader(write(2));
  // The sample's cloths are 1 m wide.
  for (const double error : {0.0, -1e-5, std::nan(""), 0.9e-8, 0.11}) {
    PlaybackCopyOptions options;
    options.position_error = error;
    EXPECT_THROW((void)playback_copy(reader, options), InvalidArgument) << error;
  }
}

}  // namespace
}  // namespace weft::scenes
