// A recording that a stranger has changed. The input is SQL that is run on a small recording, whose
// hashes are then made right again; or, if it begins as a database does, the file itself.
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>

#include <sqlite3.h>

#include <weft/scenes/format/scene_file.hpp>
#include <weft/scenes/recording/recording.hpp>
#include <weft/scenes/simulator.hpp>
#include "fuzz/fuzz_target.hpp"
#include "fuzz/recording_seal.hpp"

namespace {

using namespace weft;
using namespace weft::scenes;

constexpr const char* kScene = R"(schema = "weft-scene/1"
name = "small"
[world]
time_step = "1/100 s"
duration = "1 s"
[[cloth]]
name = "cloth"
grid = { nodes = [3, 3], size = ["1 m", "1 m"] }
mass = "1 kg"
tear = { strain = 0.5 }
[[cloth.law]]
law = "tension"
stiffness = "10 N/m"
[[collider]]
name = "ball"
shape = "sphere"
radius = "10 cm"
)";

/// A folder of this process, removed at its end.
class Folder {
 public:
  Folder()
      : path_(std::filesystem::temp_directory_path() / ("weft_fuzz_" + std::to_string(getpid()))) {
    std::filesystem::create_directories(path_);
  }
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  [[nodiscard]] std::filesystem::path operator/(const char* name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

void write_sample(const std::filesystem::path& path) {
  const Scene scene = read_scene_text(kScene, "small.toml");
  RecordingWriter writer(path, scene, {{"engine", "none"}}, StoredPrecision::kFloat32,
                         {.frames = 2});
  for (int frame = 0; frame < 5; ++frame) {
    SceneState state;
    state.time = 0.1 * frame;
    const Matrix3X<double> nodes = Matrix3X<double>::Constant(3, 9, 0.25 * frame);
    state.cloths.push_back({"cloth", nodes, nodes});
    RigidState ball;
    ball.name = "ball";
    state.rigids.push_back(ball);
    writer.add_frame(state);
    writer.add_metric("kinetic_energy_J", state.time, 0.5 * frame);
  }
  writer.set_blow_up({.step = 7, .time = 0.4, .body = "cloth", .node = 3, .reason = "test"});
  (void)writer.finish();
}

int stop(void*) {
  return 1;
}

/// Runs SQL of any kind on a file, but lets it reach no other one.
void run_sql(const std::filesystem::path& path, const std::string& sql) {
  sqlite3* connection = nullptr;
  if (sqlite3_open(path.c_str(), &connection) == SQLITE_OK) {
    sqlite3_limit(connection, SQLITE_LIMIT_ATTACHED, 0);
    sqlite3_limit(connection, SQLITE_LIMIT_LENGTH, 1'000'000);
    sqlite3_db_config(connection, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
    sqlite3_progress_handler(connection, 100'000, stop, nullptr);
    (void)sqlite3_exec(connection, sql.c_str(), nullptr, nullptr, nullptr);
  }
  sqlite3_close(connection);
}

void read_everything(const std::filesystem::path& path) {
  const RecordingReader reader(path);
  (void)reader.provenance();
  (void)reader.finished();
  (void)reader.blow_up();
  for (int frame = 0; frame < reader.num_frames(); ++frame) {
    const SceneState state = reader.frame(frame);
    fuzz::require(state.time > -1e300, "times are numbers");
  }
  for (const std::string& name : reader.metric_names()) (void)reader.metric(name);
  (void)reader.scene();
  (void)reader.content_hash();
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Folder folder;
  static const std::string sample = [] {
    write_sample(folder / "sample");
    std::ifstream file(folder / "sample", std::ios::binary);
    return std::string{std::istreambuf_iterator<char>(file), {}};
  }();
  const std::string_view text = fuzz::text_of(data, size);
  const bool is_file = text.starts_with("SQLite format 3");
  const std::filesystem::path path = folder / "input";
  std::ofstream(path, std::ios::binary | std::ios::trunc) << (is_file ? text : sample);
  if (!is_file) {
    run_sql(path, std::string(text));
    fuzz::seal_recording(path);
  }
  try {
    read_everything(path);
  } catch (const Error& error) {
    // Names from the file are quoted as they are; what prints the message makes them harmless.
    fuzz::require(std::string_view(error.what()).size() <= 2000, "an error is short");
  }
  return 0;
}
