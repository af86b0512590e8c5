#include <sqlite3.h>
#include <sys/stat.h>

#include <fstream>
#include <iterator>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <weft/scenes/recording/recording.hpp>
#include <weft/scenes/recording/storage/database.hpp>
#include <weft/scenes/recording/storage/format.hpp>

#include "tests/scenes/recording/recording_samples.hpp"

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

void damage_with_sql(const std::filesystem::path& path, const char* sql) {
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
  EXPECT_THAT(error_of(folder.path()), HasSubstr("is a directory"));
  write_bytes(folder / "empty", {});
  EXPECT_THAT(error_of(folder / "empty"), HasSubstr("empty: is empty"));
  write_bytes(folder / "text", {'h', 'i', '\n'});
  EXPECT_THAT(error_of(folder / "text"), HasSubstr("text: not a Weft recording"));
  damage_with_sql(folder / "foreign", "CREATE TABLE meta (key, value)");
  EXPECT_THAT(error_of(folder / "foreign"), HasSubstr("foreign: not a Weft recording but another"));
  write_sample(folder / "newer", make_scene(), StoredPrecision::kFloat32, 3);
  damage_with_sql(folder / "newer", "PRAGMA user_version=3");
  EXPECT_THAT(error_of(folder / "newer"), HasSubstr("newer: recording format version 3"));
  write_sample(folder / "table", make_scene(), StoredPrecision::kFloat32, 3);
  damage_with_sql(folder / "table", "DROP TABLE metric; CREATE VIEW metric AS SELECT * FROM frame");
  EXPECT_THAT(error_of(folder / "table"), HasSubstr("table: holds 'metric', which is not as in a"));
  write_sample(folder / "less", make_scene(), StoredPrecision::kFloat32, 3);
  damage_with_sql(folder / "less", "DROP TABLE metric");
  EXPECT_THAT(error_of(folder / "less"), HasSubstr("less: has no table 'metric'"));
}

// SQL of a stranger would run while the tables are read.
TEST(Damage, AForeignSchemaIsRefusedWhateverItDoes) {
  const TemporaryFolder folder;
  int number = 0;
  for (const char* sql : {
           "CREATE VIEW v AS SELECT * FROM meta",
           "CREATE TRIGGER t AFTER INSERT ON frame BEGIN DELETE FROM chunk; END",
           "CREATE INDEX i ON frame (abs(time_s))",
           "CREATE TABLE other (x)",
           "ALTER TABLE frame ADD COLUMN x AS (length(hex(zeroblob(100000000))))",
           "CREATE VIRTUAL TABLE v USING fts5(x)",
       }) {
    const auto path = folder / std::to_string(number++);
    write_sample(path, make_scene(), StoredPrecision::kFloat32, 3);
    damage_with_sql(path, sql);
    EXPECT_THAT(error_of(path), HasSubstr("which is not as in a recording")) << sql;
  }
}

/// Changes a recording as a forger does, who computes the hashes of the header too.
void forge(const std::filesystem::path& path, const char* sql) {
  damage_with_sql(path, sql);
  Database database(path, Database::Access::kReadWrite);
  Header header;
  Statement meta = database.prepare("SELECT key, value FROM meta ORDER BY key");
  while (meta.step()) header.meta[meta.text(0)] = meta.text(1);
  header.scene_text = database.query_text("SELECT text FROM scene");
  Statement bodies = database.prepare("SELECT name, kind, nodes FROM body ORDER BY id");
  while (bodies.step()) {
    header.bodies.push_back(
        {bodies.text(0), bodies.text(1) == "cloth", static_cast<int>(bodies.integer(2))});
  }
  Statement events =
      database.prepare("SELECT step, time_s, body, node, reason FROM event ORDER BY id");
  if (events.step()) {
    header.blow_up = BlowUp{static_cast<int>(events.integer(0)), events.real(1), events.text(2),
                            static_cast<int>(events.integer(3)), events.text(4)};
  }
  const std::string hash = header_hash(header);
  database.prepare("UPDATE meta SET value = ? WHERE key = 'meta_hash'")
      .bind(1, std::string_view(hash))
      .run();
}

/// The error of opening a forged recording and of read(reader).
template <class Read>
std::string error_after(const std::filesystem::path& path, const std::string& sql,
                        const Read& read) {
  write_sample(path, make_scene(), StoredPrecision::kFloat32, 3);
  forge(path, sql.c_str());
  try {
    const RecordingReader reader(path);
    read(reader);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(Damage, AForgedRecordingReadsNoFileOfItsReader) {
  const TemporaryFolder folder;
  write_bytes(folder / "secret.obj", {'v', ' ', '0', '\n'});
  const std::string absolute = (folder / "secret.obj").string();
  const std::string grid = "grid = { nodes = [3, 3], size = [\"1 m\", \"1 m\"] }\n";
  int number = 0;
  for (const std::string& cloth : {
           std::string("mesh = { file = \"secret.obj\" }"),
           "mesh = { file = \"" + absolute + "\" }",
           grid + "texture = \"secret.png\"",
           grid + "pin = [{ texture = \"secret.png\" }]",
           grid + "[[character]]\nname = \"c\"\nfile = \"secret.glb\"",
       }) {
    const std::string text =
        "schema = \"weft-scene/1\"\nname = \"forged\"\n[world]\ntime_step = \"1/100 s\"\n"
        "duration = \"1 s\"\n[[cloth]]\nname = \"towel\"\nmass = \"1 kg\"\n" +
        cloth + "\n";
    const std::string error =
        error_after(folder / std::to_string(number++), "UPDATE scene SET text = '" + text + "'",
                    [](const RecordingReader& reader) { (void)reader.scene(); });
    EXPECT_THAT(error, HasSubstr("is not in the recording, expected one that needs no other file"))
        << cloth;
  }
}

TEST(Damage, AForgedSizeAsksForNoMemory) {
  const TemporaryFolder folder;
  const auto read_metrics = [](const RecordingReader& reader) { (void)reader.metric_names(); };
  const auto error = [&](const char* name, const char* sql) {
    return error_after(folder / name, sql, read_metrics);
  };
  EXPECT_THAT(error("nodes", "UPDATE body SET nodes = 2147483647 WHERE id = 0"),
              HasSubstr("bytes, expected at most"));
  EXPECT_THAT(error("chunk", "UPDATE chunk SET raw_bytes = 2900000000"),
              HasSubstr("bytes, expected at most"));
  EXPECT_THAT(error("metrics", "UPDATE meta SET value = 'many' WHERE key = 'num_metrics'"),
              HasSubstr("'num_metrics' in table meta is no number"));
  EXPECT_THAT(error("index", "DELETE FROM meta WHERE key = 'index_hash'"),
              HasSubstr("has no 'index_hash' in table meta"));
}

TEST(Damage, AForgedBodyIsNotThatOfTheScene) {
  const TemporaryFolder folder;
  const auto path = folder / "a";
  write_sample(path, make_scene(), StoredPrecision::kFloat32, 3);
  // The frames have the same size as before.
  forge(path,
        "UPDATE body SET nodes = nodes - 1 WHERE id = 0; "
        "UPDATE body SET nodes = nodes + 1 WHERE id = 1");
  const RecordingReader reader(path);
  try {
    (void)reader.scene();
    FAIL() << "read";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("table body has not the bodies of the scene"));
  }
}

TEST(Damage, APipeIsRefusedAtOnce) {
  const TemporaryFolder folder;
  ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
  EXPECT_THAT(error_of(folder / "pipe"), HasSubstr("expected a regular file"));
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
    damage_with_sql(path, sql);
    EXPECT_THAT(error_of(path), HasSubstr(path.string() + ": ")) << sql;
  }
}

TEST(Damage, AWrongChunkIsNamedAndTheOthersStayReadable) {
  const TemporaryFolder folder;
  const auto path = folder / "a";
  write_sample(path, make_scene(), StoredPrecision::kFloat32, 9, {.frames = 3});
  damage_with_sql(
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
void expect_error_or_undamaged(const std::filesystem::path& damaged,
                               const std::filesystem::path& base, std::size_t stride,
                               const std::string& undamaged) {
  std::vector<char> bytes = read_bytes(damaged);
  int num_errors = 0;
  for (std::size_t i = 0; i < bytes.size(); i += stride) {
    for (const int mask : {0x01, 0x80, 0xff}) {
      const char original = bytes[i];
      bytes[i] = static_cast<char>(bytes[i] ^ mask);
      write_bytes(damaged, bytes);
      try {
        ASSERT_EQ(read_everything(base), undamaged) << "byte " << i << " mask " << mask;
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
  const std::string undamaged = read_everything(folder / "a");
  constexpr std::size_t kStride = 29;
  expect_error_or_undamaged(folder / "a", folder / "a", kStride, undamaged);
}

}  // namespace
}  // namespace weft::scenes
