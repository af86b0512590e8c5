#include <sqlite3.h>

#include <fstream>
#include <iterator>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <weft/scenes/recording/recording.hpp>

#include "tests/recording/recording_samples.hpp"

namespace weft::scenes {
namespace {

using samples::make_scene;
using samples::TemporaryFolder;
using samples::write_sample;
using testing::HasSubstr;

std::vector<char> read_bytes(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

void write_bytes(const std::filesystem::path& path, const std::vector<char>& bytes) {
  std::ofstream(path, std::ios::binary)
      .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

void run_sql(const std::filesystem::path& path, const char* sql) {
  sqlite3* connection = nullptr;
  ASSERT_EQ(sqlite3_open(path.c_str(), &connection), SQLITE_OK);
  EXPECT_EQ(sqlite3_exec(connection, sql, nullptr, nullptr, nullptr), SQLITE_OK)
      << sqlite3_errmsg(connection);
  sqlite3_close(connection);
}

/// Everything that can be read, as one text: what is shown must be right or not be shown.
std::string read_everything(const std::filesystem::path& path) {
  const RecordingReader reader(path);
  std::string all = reader.content_hash() + reader.scene_text() + reader.scene().name;
  all += reader.finished() ? "finished" : "unfinished";
  for (const auto& [key, value] : reader.provenance()) {
    all += key + "=" + value + ";";
  }
  if (const auto blow_up = reader.blow_up()) {
    all += blow_up->body + blow_up->reason + std::to_string(blow_up->step) +
           std::to_string(blow_up->node);
  }
  for (int i = 0; i < reader.num_frames(); ++i) {
    all += std::to_string(reader.frame(i).cloths[0].positions.sum()) +
           std::to_string(reader.frame_time(i));
  }
  for (const std::string& name : reader.metric_names()) {
    for (const auto& sample : reader.metric(name)) {
      all += name + std::to_string(sample.time) + std::to_string(sample.value);
    }
  }
  return all;
}

std::string error_of(const std::filesystem::path& path) {
  try {
    (void)read_everything(path);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(Damage, EveryKindHasAnErrorOfItsOwn) {
  const TemporaryFolder folder;
  EXPECT_THAT(error_of(folder / "missing"), HasSubstr("missing: no such file"));
  EXPECT_THAT(error_of(folder.path()), HasSubstr("not a file"));
  write_bytes(folder / "empty", {});
  EXPECT_THAT(error_of(folder / "empty"), HasSubstr("empty: is empty"));
  write_bytes(folder / "text", {'h', 'i', '\n'});
  EXPECT_THAT(error_of(folder / "text"), HasSubstr("text: not a Weft recording"));
  run_sql(folder / "foreign", "CREATE TABLE meta (key, value)");
  EXPECT_THAT(error_of(folder / "foreign"), HasSubstr("foreign: not a Weft recording but another"));
  write_sample(folder / "newer", make_scene(), StoredPrecision::kFloat32, 3);
  run_sql(folder / "newer", "PRAGMA user_version=3");
  EXPECT_THAT(error_of(folder / "newer"), HasSubstr("newer: recording format version 3"));
  write_sample(folder / "table", make_scene(), StoredPrecision::kFloat32, 3);
  run_sql(folder / "table", "DROP TABLE metric; CREATE VIEW metric AS SELECT * FROM frame");
  EXPECT_THAT(error_of(folder / "table"), HasSubstr("table: has no table 'metric'"));
}

TEST(Damage, ChangedRowsAreErrors) {
  const TemporaryFolder folder;
  int number = 0;
  for (const char* sql : {
           "UPDATE meta SET value='no' WHERE key='finished'",
           "DELETE FROM meta WHERE key='precision'",
           "DELETE FROM meta",
           "UPDATE meta SET value=NULL OR 1 WHERE key='precision'",
           "UPDATE scene SET text=text || ' '",
           "DELETE FROM scene",
           "UPDATE body SET name='x' WHERE id=1",
           "UPDATE body SET nodes=2147483647",
           "UPDATE body SET nodes='many'",
           "UPDATE body SET kind='gas'",
           "UPDATE frame SET time_s=time_s+1e-9 WHERE id=2",
           "UPDATE frame SET time_s='noon' WHERE id=2",
           "DELETE FROM frame WHERE id=2",
           "INSERT INTO frame VALUES (99, 99.0, 0)",
           "DELETE FROM chunk",
           "UPDATE chunk SET num_frames=1000000000000",
           "UPDATE chunk SET num_frames=-1",
           "UPDATE chunk SET raw_bytes=1000000000000",
           "UPDATE chunk SET codec='none'",
           "UPDATE chunk SET data=x'00'",
           "UPDATE chunk SET data=''",
           "UPDATE chunk SET hash=''",
           "UPDATE metric SET value=value+1 WHERE id=2",
           "DELETE FROM metric WHERE id=3",
           "UPDATE event SET reason='none'",
           "DELETE FROM event",
       }) {
    const auto path = folder / std::to_string(number++);
    write_sample(path, make_scene(), StoredPrecision::kFloat32, 3);
    run_sql(path, sql);
    EXPECT_THAT(error_of(path), HasSubstr(path.string() + ": ")) << sql;
  }
}

TEST(Damage, AWrongChunkIsNamedAndTheOthersStayReadable) {
  const TemporaryFolder folder;
  const auto path = folder / "a";
  write_sample(path, make_scene(), StoredPrecision::kFloat32, 9, {.frames = 3});
  run_sql(
      path,
      "UPDATE chunk SET data=CAST(substr(data, 1, length(data)-1) || x'5a' AS BLOB) WHERE id=1");
  const RecordingReader reader(path);
  EXPECT_NO_THROW((void)reader.frame(2));
  EXPECT_NO_THROW((void)reader.frame(6));
  try {
    (void)reader.frame(4);
    FAIL() << "read";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr(path.string()));
    EXPECT_THAT(error.what(), HasSubstr("chunk 1, frames 3 to 5"));
  }
}

TEST(Damage, ATruncatedFileIsAnErrorAtEveryLength) {
  const TemporaryFolder folder;
  write_sample(folder / "whole", make_scene(), StoredPrecision::kFloat32, 9);
  const std::vector<char> bytes = read_bytes(folder / "whole");
  constexpr std::size_t kStride = 509;  // a prime: all places within a page
  for (std::size_t size = 0; size < bytes.size(); size += kStride) {
    write_bytes(folder / "part",
                {bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size)});
    EXPECT_THAT(error_of(folder / "part"), HasSubstr("part: ")) << size;
  }
  write_bytes(folder / "part", {bytes.begin(), bytes.end() - 1});
  EXPECT_THAT(error_of(folder / "part"), HasSubstr("truncated"));
}

/// Changes each kStride-th byte of a file, one at a time; whatever can then be read must be
/// unchanged.
void expect_error_or_truth(const std::filesystem::path& damaged, const std::filesystem::path& base,
                           std::size_t stride, const std::string& truth) {
  std::vector<char> bytes = read_bytes(damaged);
  int num_errors = 0;
  for (std::size_t i = 0; i < bytes.size(); i += stride) {
    for (const int mask : {0x01, 0x80, 0xff}) {
      const char original = bytes[i];
      bytes[i] = static_cast<char>(bytes[i] ^ mask);
      write_bytes(damaged, bytes);
      try {
        ASSERT_EQ(read_everything(base), truth) << "byte " << i << " mask " << mask;
      } catch (const Error& error) {
        ++num_errors;
        ASSERT_THAT(error.what(), HasSubstr(base.string())) << "byte " << i;
        ASSERT_THAT(error.what(), testing::Not(HasSubstr("\n")));
      }
      bytes[i] = original;
    }
  }
  EXPECT_GT(num_errors, 0);
}

TEST(Damage, AFlippedByteIsAnErrorOrMakesNoDifference) {
  const TemporaryFolder folder;
  write_sample(folder / "a", make_scene(), StoredPrecision::kFloat32, 9, {.frames = 3},
               {{"engine", "fake"}, {"flags", "-O2"}});
  const std::string truth = read_everything(folder / "a");
  constexpr std::size_t kStride = 29;
  expect_error_or_truth(folder / "a", folder / "a", kStride, truth);
}

}  // namespace
}  // namespace weft::scenes
