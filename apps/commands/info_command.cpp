#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

#include <fmt/core.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <weft/core/error.hpp>
#include <weft/engines/engine_table.hpp>
#include <weft/scenes/format/scene_words.hpp>
#include <weft/scenes/recording/own_loop.hpp>
#include <weft/scenes/recording/recording.hpp>
#include <weft/scenes/recording/storage/format.hpp>
#include <weft/validation/report/formats/json_text.hpp>

#include "apps/app.hpp"
#include "apps/progress/partial_note.hpp"
#include "apps/terminal.hpp"

namespace weft::app {
namespace {

using Json = nlohmann::ordered_json;

struct InfoOptions {
  std::vector<std::string> files;
  bool as_json = false;
};

/// A cloth that tears gets more nodes, and its faces stay as many.
struct ClothSize {
  Eigen::Index nodes = 0;         ///< of the scene's mesh
  Eigen::Index nodes_at_end = 0;  ///< in the last frame
  Eigen::Index faces = 0;
};

/// Everything that the command shows of a recording and the reader does not give in one call.
struct Contents {
  std::string file;
  std::string content_hash;
  std::vector<ClothSize> cloths;
  std::uintmax_t num_bytes = 0;
  bool has_log = false;  ///< a part of the bytes is in the -wal file beside the recording
};

std::uintmax_t size_or_zero(const std::filesystem::path& path) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  return error ? 0 : size;
}

std::vector<ClothSize> cloth_sizes(const scenes::RecordingReader& reader) {
  std::vector<ClothSize> sizes;
  std::optional<scenes::SceneState> last;
  if (reader.num_frames() > 0) last = reader.frame(reader.num_frames() - 1);
  for (std::size_t c = 0; c < reader.scene().cloths.size(); ++c) {
    const ClothMesh mesh = scenes::make_mesh(reader.scene().cloths[c]);
    const Eigen::Index nodes = mesh.rest_positions.cols();
    sizes.push_back(
        {nodes, last ? last->cloths[c].positions.cols() : nodes, mesh.triangles.cols()});
  }
  return sizes;
}

Contents contents_of(const scenes::RecordingReader& reader, const std::string& file) {
  Contents contents;
  contents.file = file;
  contents.content_hash = reader.content_hash();  // reads and checks every frame
  contents.cloths = cloth_sizes(reader);
  const std::uintmax_t log = size_or_zero(file + "-wal");
  contents.has_log = !reader.finished() && log > 0;
  contents.num_bytes = size_or_zero(file) + (contents.has_log ? log : 0);
  return contents;
}

std::string recorded_engine(const scenes::RecordingReader& reader) {
  const auto engine = reader.provenance().find("engine");
  return engine == reader.provenance().end() ? "" : engine->second;
}

/// Such a scene has a time step and a duration only because each scene has them.
bool is_own_loop(const scenes::RecordingReader& reader) {
  return recorded_engine(reader) == scenes::kOwnLoop;
}

std::string shape_word(const scenes::Collider& collider) {
  return std::string(scenes::kShapeWords.at(collider.shape.index()));
}

bool is_prescribed(const scenes::Collider& collider) {
  return collider.path.has_value() || !collider.led_by.empty();
}

std::string motion_of(const scenes::Collider& collider) {
  if (collider.mass) return fmt::format("{:.6g} kg", *collider.mass);
  return is_prescribed(collider) ? "its motion is prescribed" : "fixed";
}

std::string bytes_text(std::uintmax_t bytes) {
  const auto value = static_cast<double>(bytes);
  if (value < 1e3) return fmt::format("{} bytes", bytes);
  return value < 1e6 ? fmt::format("{:.3g} kB", 1e-3 * value)
                     : fmt::format("{:.2f} MB", 1e-6 * value);
}

void print_bodies(const scenes::Scene& scene, const std::vector<ClothSize>& sizes) {
  for (std::size_t c = 0; c < sizes.size(); ++c) {
    const ClothSize& size = sizes[c];
    print("  cloth '{}': {} nodes, {} faces{}\n", scene.cloths[c].name, size.nodes, size.faces,
          size.nodes_at_end > size.nodes
              ? fmt::format("; torn, {} nodes in the last frame", size.nodes_at_end)
              : "");
  }
  for (const scenes::Collider& collider : scene.colliders) {
    print("  rigid body '{}': {}, {}\n", collider.name, shape_word(collider), motion_of(collider));
  }
}

void print_info(const scenes::RecordingReader& reader, const Contents& contents) {
  const scenes::Scene& scene = reader.scene();
  print("{}: {} recording of scene '{}'\n", contents.file,
        reader.finished() ? "finished" : "partial", scene.name);
  if (reader.num_frames() == 0) {
    print("  no frame\n");
  } else {
    const int last = reader.num_frames() - 1;
    print("  {} frames, t = {:.6g} s to {:.6g} s{}\n", reader.num_frames(), reader.frame_time(0),
          reader.frame_time(last),
          is_own_loop(reader) ? "" : fmt::format(" of {:.6g} s", scene.world.duration));
  }
  if (const std::optional<scenes::BlowUp> blow_up = reader.blow_up()) {
    print("  blew up at step {}, t = {:.6g} s, body '{}', node {}: {}\n", blow_up->step,
          blow_up->time, blow_up->body, blow_up->node, blow_up->reason);
  }
  for (const scenes::Note& note : reader.notes()) {
    print("  t = {:.6g} s: {}\n", note.time, note.text);
  }
  const std::string engine = recorded_engine(reader);
  print("  engine {}, {}; {}frame interval {:.6g} s\n", engine.empty() ? "unknown" : engine,
        scenes::to_string(reader.precision()),
        is_own_loop(reader) ? "" : fmt::format("time step {:.6g} s, ", scene.world.time_step),
        scene.world.frame_interval);
  print_bodies(scene, contents.cloths);
  for (const auto& [key, value] : reader.provenance()) {
    if (key != "engine" && key != "precision") print("  {}: {}\n", key, value);
  }
  print("  format version {}, {}{}\n  content hash {}\n", scenes::format_version(scene),
        bytes_text(contents.num_bytes), contents.has_log ? " with the -wal file beside it" : "",
        contents.content_hash);
  note_if_partial(reader, contents.file);
}

Json json_of(const std::optional<scenes::BlowUp>& blow_up) {
  if (!blow_up) return nullptr;
  return {{"step", blow_up->step},
          {"time_s", blow_up->time},
          {"body", blow_up->body},
          {"node", blow_up->node},
          {"reason", blow_up->reason}};
}

Json json_of(const std::vector<scenes::Note>& notes) {
  Json events = Json::array();
  for (const scenes::Note& note : notes) {
    events.push_back({{"time_s", note.time}, {"text", note.text}});
  }
  return events;
}

Json json_of(const scenes::Scene& scene, const std::vector<ClothSize>& sizes) {
  Json bodies = Json::array();
  for (std::size_t c = 0; c < sizes.size(); ++c) {
    const ClothSize& size = sizes[c];
    bodies.push_back({{"name", scene.cloths[c].name},
                      {"kind", "cloth"},
                      {"nodes", size.nodes},
                      {"nodes_at_end", size.nodes_at_end},
                      {"faces", size.faces}});
  }
  for (const scenes::Collider& collider : scene.colliders) {
    bodies.push_back({{"name", collider.name},
                      {"kind", "rigid"},
                      {"shape", shape_word(collider)},
                      {"mass_kg", collider.mass ? Json(*collider.mass) : Json(nullptr)},
                      {"is_prescribed", is_prescribed(collider)}});
  }
  return bodies;
}

Json json_of(const scenes::RecordingReader& reader, const Contents& contents) {
  const scenes::Scene& scene = reader.scene();
  const int last = reader.num_frames() - 1;
  const std::string engine = recorded_engine(reader);
  const bool own = is_own_loop(reader);
  return {{"file", contents.file},
          {"size_bytes", contents.num_bytes},
          {"format_version", scenes::format_version(scene)},
          {"scene", scene.name},
          {"is_finished", reader.finished()},
          {"engine", engine.empty() ? Json(nullptr) : Json(engine)},
          {"precision", scenes::to_string(reader.precision())},
          {"time_step_s", own ? Json(nullptr) : Json(scene.world.time_step)},
          {"frame_interval_s", scene.world.frame_interval},
          {"duration_s", own ? Json(nullptr) : Json(scene.world.duration)},
          {"frames", reader.num_frames()},
          {"first_time_s", last < 0 ? Json(nullptr) : Json(reader.frame_time(0))},
          {"last_time_s", last < 0 ? Json(nullptr) : Json(reader.frame_time(last))},
          {"bodies", json_of(scene, contents.cloths)},
          {"blow_up", json_of(reader.blow_up())},
          {"notes", json_of(reader.notes())},
          {"provenance", Json(reader.provenance())},
          {"content_hash", contents.content_hash}};
}

int show_all(const InfoOptions& options) {
  int exit_code = kOk;
  Json objects = Json::array();
  for (const std::string& file : options.files) {
    try {
      const scenes::RecordingReader reader(file);
      const Contents contents = contents_of(reader, file);
      if (options.as_json) {
        objects.push_back(json_of(reader, contents));
      } else {
        print_info(reader, contents);
      }
    } catch (const Error& error) {
      print(stderr, "weft: {}\n", error.what());
      exit_code = kBadInput;
    }
  }
  if (options.as_json) write_data(stdout, validation::json_text(objects));
  return exit_code;
}

}  // namespace

Action add_info_command(CLI::App& parser) {
  CLI::App* command = parser.add_subcommand(
      "info", "What is in a recording, finished or partial; checks every frame");
  auto options = std::make_shared<InfoOptions>();
  command->add_option("RECORDING", options->files, "Recordings made by `weft run`")->required();
  command->add_flag("--json", options->as_json,
                    "For programs: a JSON array with one object for each recording, in SI units");
  return [options] { return show_all(*options); };
}

}  // namespace weft::app
