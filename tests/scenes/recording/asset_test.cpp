#include <sqlite3.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <weft/scenes/recording/recording.hpp>

#include "tests/scenes/recording/recording_samples.hpp"

namespace weft::scenes {
namespace {

using samples::make_scene;
using samples::TemporaryFolder;
using samples::write_sample;
using testing::HasSubstr;

/// The smallest picture that libpng reads: one grey pixel.
std::string one_pixel() {
  const unsigned char bytes[] = {
      0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48,
      0x44, 0x52, 0x00, 0x00, 0x00, 0x01, 0x00, 0x00, 0x00, 0x01, 0x08, 0x00, 0x00, 0x00,
      0x00, 0x3a, 0x7e, 0x9b, 0x55, 0x00, 0x00, 0x00, 0x0a, 0x49, 0x44, 0x41, 0x54, 0x78,
      0x9c, 0x63, 0x68, 0x00, 0x00, 0x00, 0x82, 0x00, 0x81, 0x77, 0xcd, 0x72, 0xb6, 0x00,
      0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82};
  return {reinterpret_cast<const char*>(bytes), sizeof bytes};
}

Scene scene_with_picture() {
  Scene scene = make_scene();
  scene.cloths[0].appearance.image = "a.png";
  scene.files.push_back({"a.png", one_pixel()});
  return scene;
}

int count_rows(const std::filesystem::path& path, const char* sql) {
  sqlite3* connection = nullptr;
  int count = -1;
  EXPECT_EQ(sqlite3_open(path.c_str(), &connection), SQLITE_OK);
  const auto keep = [](void* to, int, char** values, char**) {
    *static_cast<int*>(to) = std::atoi(values[0]);
    return 0;
  };
  EXPECT_EQ(sqlite3_exec(connection, sql, keep, &count, nullptr), SQLITE_OK);
  sqlite3_close(connection);
  return count;
}

TEST(Asset, TravelsWithTheRecording) {
  const TemporaryFolder folder;
  const Scene scene = scene_with_picture();
  (void)write_sample(folder / "a", scene, StoredPrecision::kFloat64, 3);
  const RecordingReader reader(folder / "a");
  ASSERT_EQ(reader.scene().files.size(), 1U);
  EXPECT_EQ(reader.scene().files[0].name, "a.png");
  EXPECT_EQ(reader.scene().files[0].bytes, one_pixel());
  EXPECT_EQ(reader.scene().cloths[0].appearance.image, "a.png");
}

TEST(Asset, LeavesNoTraceInARecordingWithoutOne) {
  const TemporaryFolder folder;
  (void)write_sample(folder / "a", make_scene(), StoredPrecision::kFloat64, 3);
  EXPECT_EQ(count_rows(folder / "a", "SELECT count(*) FROM sqlite_master WHERE name = 'asset'"), 0);
  EXPECT_EQ(count_rows(folder / "a", "SELECT count(*) FROM meta WHERE key = 'asset_hash'"), 0);
}

TEST(Asset, IsNoPartOfTheContentHash) {
  const TemporaryFolder folder;
  Scene scene = scene_with_picture();
  const std::string hash = write_sample(folder / "a", scene, StoredPrecision::kFloat64, 3);
  scene.files[0].bytes += "another file with the same name";
  EXPECT_EQ(write_sample(folder / "b", scene, StoredPrecision::kFloat64, 3), hash);
}

TEST(Asset, ThatIsDamagedIsNoticed) {
  for (const char* sql : {"UPDATE asset SET name = 'b.png'", "UPDATE asset SET data = x'00'",
                          "DELETE FROM asset", "DROP TABLE asset"}) {
    const TemporaryFolder folder;
    (void)write_sample(folder / "a", scene_with_picture(), StoredPrecision::kFloat64, 3);
    sqlite3* connection = nullptr;
    ASSERT_EQ(sqlite3_open((folder / "a").c_str(), &connection), SQLITE_OK);
    ASSERT_EQ(sqlite3_exec(connection, sql, nullptr, nullptr, nullptr), SQLITE_OK);
    sqlite3_close(connection);
    const RecordingReader reader(folder / "a");
    EXPECT_THAT([&] { (void)reader.scene(); },
                testing::ThrowsMessage<Error>(HasSubstr("the file is damaged")))
        << sql;
  }
}

}  // namespace
}  // namespace weft::scenes
