#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include <weft/core/error.hpp>
#include <weft/engines/engine_table.hpp>
#include <weft/playback/exchange/import/recording_import.hpp>
#include <weft/scenes/catalog.hpp>
#include <weft/scenes/recording/recording.hpp>
#include <weft/scenes/recording/recording_output.hpp>

#include "apps/app.hpp"
#include "apps/progress/interruption.hpp"
#include "apps/progress/progress_bar.hpp"
#include "apps/provenance.hpp"
#include "apps/quantity_option.hpp"
#include "apps/terminal.hpp"

namespace weft::app {
namespace {

struct FileImportOptions {
  std::string scene;
  std::vector<std::string> caches;
  std::vector<std::string> sequences;
  std::string frame_rate;
  std::string up = "y";
  std::string unit = "1 m";
  std::string other_start;
  std::string output;
  bool force = false;
};

/// Which body a file is for.
struct NamedFile {
  std::string body;
  std::string file;
};

/// "BODY=FILE", or only "FILE" where the scene has one cloth. A sign = that stands behind no body's name belongs to the file.
NamedFile named_file(const std::string& option, const std::string& text,
                     const scenes::Scene& scene) {
  const std::size_t sign = text.find('=');
  const std::string body = text.substr(0, sign);
  const auto is_it = [&](const auto& other) { return other.name == body; };
  const bool is_body = std::any_of(scene.cloths.begin(), scene.cloths.end(), is_it) ||
                       std::any_of(scene.colliders.begin(), scene.colliders.end(), is_it);
  if (sign != std::string::npos && is_body) return {body, text.substr(sign + 1)};
  if (scene.cloths.size() == 1) return {scene.cloths.front().name, text};
  throw InvalidArgument(
      fmt::format("{} {}: names no body of scene '{}', which has {} cloths, expected "
                  "BODY=FILE such as {}={}",
                  option, text, scene.name, scene.cloths.size(), scene.cloths.front().name, text));
}

scenes::FileAxes axes_of(const FileImportOptions& options) {
  scenes::FileAxes axes{options.up == "z", quantity_option("--unit", options.unit, "m")};
  if (!(axes.length_unit > 0)) {
    throw InvalidArgument(fmt::format("--unit \"{}\": expected a length > 0", options.unit));
  }
  return axes;
}

std::vector<scenes::ImportedBody> read_bodies(const FileImportOptions& options,
                                              const scenes::Scene& scene) {
  if (options.caches.empty() && options.sequences.empty()) {
    throw InvalidArgument("import: expected --pc2 FILE or --obj-sequence FOLDER");
  }
  const scenes::FileAxes axes = axes_of(options);
  std::vector<scenes::ImportedBody> bodies;
  for (const std::string& text : options.caches) {
    const NamedFile named = named_file("--pc2", text, scene);
    bodies.push_back({named.body, scenes::read_point_cache_sequence(named.file, axes)});
  }
  for (const std::string& text : options.sequences) {
    const NamedFile named = named_file("--obj-sequence", text, scene);
    bodies.push_back({named.body, scenes::read_obj_sequence(named.file, axes)});
  }
  return bodies;
}

std::string write(const scenes::Scene& scene, const scenes::Import& imported,
                  const FileImportOptions& options, const std::filesystem::path& partial) {
  scenes::Provenance provenance = build_provenance();
  provenance.insert(imported.provenance.begin(), imported.provenance.end());
  provenance["precision"] = scenes::to_string(imported.precision);
  provenance["imported_axes"] = fmt::format("{} is up, one unit is {}", options.up, options.unit);
  scenes::RecordingWriter writer(partial, scene, provenance, imported.precision);
  ProgressBar progress("import");
  const Interruption interruption;
  for (std::size_t i = 0; i < imported.frames.size(); ++i) {
    writer.add_frame(imported.frames[i]);
    progress.update(static_cast<double>(i + 1) / static_cast<double>(imported.frames.size()));
    Interruption::check();
  }
  return writer.finish();
}

std::string faces_text(const scenes::ShapeSequence& shapes) {
  if (!shapes.faces.empty()) return "faces as in the scene (" + shapes.faces_source + ")";
  return shapes.faces_source.empty()
             ? "no OBJ file of the same name beside it, so its faces are not checked"
             : shapes.faces_source + " has no faces, so they are not checked";
}

void report(const scenes::Scene& scene, const scenes::Import& imported,
            const std::vector<scenes::ImportedBody>& bodies, const std::string& output) {
  const double interval = imported.frames[1].time - imported.frames[0].time;
  print(
      "{}: {} frames of scene '{}', {:.6g} s apart; the first is within {:.3g} m of the scene's "
      "start\n",
      output, imported.frames.size(), scene.name, interval, imported.start_distance);
  for (const scenes::ImportedBody& body : bodies) {
    print("  '{}' from {}: {}\n", body.name, body.shapes.source, faces_text(body.shapes));
  }
  if (std::abs(interval - scene.world.frame_interval) > 1e-3 * scene.world.frame_interval) {
    print("  weft validate --recording needs frames {:.6g} s apart, as the scene has them\n",
          scene.world.frame_interval);
  }
}

int import_files(const FileImportOptions& options) {
  const scenes::Scene scene = scenes::load_scene(options.scene);
  const double frame_rate = quantity_option("--frame-rate", options.frame_rate, "1/s");
  const std::vector<scenes::ImportedBody> bodies = read_bodies(options, scene);
  const scenes::Import imported =
      scenes::import_states(scene, bodies, {frame_rate, options.other_start});
  const scenes::RecordingOutput output(options.output, options.force);
  std::string hash;
  try {
    hash = write(scene, imported, options, output.partial());
  } catch (...) {
    output.discard();  // nothing is lost: all of it is in the files that were read
    throw;
  }
  output.publish();
  report(scene, imported, bodies, options.output);
  print("content hash {}\n", hash);
  return kOk;
}

}  // namespace

Action add_import_command(CLI::App& parser) {
  CLI::App* command = parser.add_subcommand(
      "import", "Make a recording of a scene from another program's point caches or OBJ files");
  auto options = std::make_shared<FileImportOptions>();
  command->add_option("SCENE", options->scene, "Catalog name or scene file that was simulated")
      ->required();
  command->add_option(
      "--pc2", options->caches,
      "Point cache of a body, as BODY=FILE (FILE alone if the scene has one cloth); "
      "its points are the nodes of the scene, in their order. Once for each cloth, and "
      "for each collider that moves freely. An OBJ file of the same name beside it "
      "tells the faces, which are then checked");
  command->add_option("--obj-sequence", options->sequences,
                      "OBJ files of a body, one for each frame, as BODY=FOLDER or "
                      "BODY=\"FOLDER/cloth_*.obj\"; the last number in a name is the frame");
  command
      ->add_option("--frame-rate", options->frame_rate,
                   "Frames of the other program per second, e.g. \"50 Hz\"")
      ->required();
  command->add_option("--up", options->up, "Which axis of the files is up")
      ->check(CLI::IsMember({"y", "z"}))
      ->capture_default_str();
  command->add_option("--unit", options->unit, "Length of one unit of the files")
      ->capture_default_str();
  command->add_option(
      "--other-start", options->other_start,
      "Why the first frame is not the scene's start, which is refused else; the text "
      "becomes part of the recording");
  command->add_option("-o,--output", options->output, "Recording to write")->required();
  command->add_flag("-f,--force", options->force, "Replace an existing recording");
  return [options] { return import_files(*options); };
}

}  // namespace weft::app
