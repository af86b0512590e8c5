#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <weft/core/error.hpp>
#include <weft/playback/exchange/gltf/glb_writer.hpp>
#include <weft/playback/exchange/gltf/gltf_export.hpp>
#include <weft/playback/exchange/point_cache_export.hpp>
#include <weft/playback/exchange/unfit_recording.hpp>
#include <weft/playback/exchange/vtp_export.hpp>
#include <weft/playback/export/cloth_energy.hpp>
#include <weft/playback/export/player_page.hpp>
#include <weft/playback/rendering/image.hpp>
#include <weft/playback/rendering/renderer.hpp>
#include <weft/scenes/output/output_file.hpp>
#include <weft/scenes/recording/playback_copy.hpp>
#include <weft/scenes/recording/recording.hpp>

#include "apps/app.hpp"
#include "apps/progress/partial_note.hpp"
#include "apps/progress/progress_bar.hpp"
#include "apps/quantity_option.hpp"
#include "apps/terminal.hpp"

namespace weft::app {
namespace {

/// Rounding moves a node by this part of the largest cloth, unless --error says otherwise: a tenth of
/// a pixel on a screen that shows it in 10,000 pixels.
constexpr double kErrorOfSize = 1e-5;

struct ExportOptions {
  std::vector<std::string> recordings;
  std::string page;
  std::string player;
  std::string error;
  std::string pc2;
  std::string vtp;
  std::string gltf;
  std::string gltf_error;
};

/// The next 1, 2 or 5 times a power of ten that is not larger.
double round_down(double value) {
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  for (const double digit : {5.0, 2.0}) {
    if (digit * power <= value) return digit * power;
  }
  return power;
}

double position_error(const ExportOptions& options, const scenes::Scene& scene) {
  if (!options.error.empty()) return quantity_option("--error", options.error, "m");
  double largest = 0.0;
  for (const scenes::Cloth& cloth : scene.cloths) {
    largest = std::max(largest, scenes::body_size(cloth.source));
  }
  return round_down(kErrorOfSize * largest);
}

/// The frame of the scene's most telling time.
int poster_frame(const scenes::RecordingReader& reader) {
  const int last = reader.num_frames() - 1;
  const auto& time = reader.scene().camera.poster_time;
  if (!time) return last;
  int frame = 0;
  while (frame < last && reader.frame_time(frame) < *time) ++frame;
  return frame;
}

std::string poster(const scenes::RecordingReader& reader, int frame) {
  scenes::RenderOptions options;
  options.samples = 3;
  return scenes::encode_jpeg(scenes::Renderer(reader.scene()).render(reader.frame(frame), options));
}

scenes::PageRecording packed(const std::string& file, const ExportOptions& options) {
  const scenes::RecordingReader reader(file);
  if (reader.num_frames() == 0) throw Error(file + ": has no frame to show");
  note_if_partial(reader, file);
  scenes::PlaybackCopyOptions copy;
  copy.position_error = position_error(options, reader.scene());
  copy.metrics = scenes::cloth_energies(reader);
  const int frame = poster_frame(reader);
  scenes::PageRecording recording;
  recording.name = std::filesystem::path(file).filename().string();
  recording.poster_jpeg = poster(reader, frame);
  recording.poster_text =
      fmt::format("{} at t = {:.4g} s", reader.scene().name, reader.frame_time(frame));
  {
    ProgressBar progress(recording.name);
    copy.on_progress = [&](double part) { progress.update(part); };
    recording.copy = scenes::playback_copy(reader, copy);
  }
  print("{}: {} frames, t = {:.6g} s to {:.6g} s; positions rounded by at most {:.3g} mm\n", file,
        reader.num_frames(), reader.frame_time(0), reader.frame_time(reader.num_frames() - 1),
        1e3 * copy.position_error);
  return recording;
}

void write_page(const output::OutputFile& output,
                const std::vector<scenes::PageRecording>& recordings) {
  const std::string html = scenes::player_page(recordings);
  output.write(html);
  print("{}: {:.2f} MB\n", output.path().string(), 1e-6 * static_cast<double>(html.size()));
}

/// Writes OBJ files with point caches.
void write_point_caches(const scenes::RecordingReader& reader, const ExportOptions& options) {
  const output::OutputFolder folder = scenes::point_cache_folder(options.pc2);
  scenes::PointCacheReport report;
  {
    ProgressBar progress("pc2");
    report =
        scenes::export_point_caches(reader, folder, [&](double part) { progress.update(part); });
  }
  print("{}: {} bodies, {} samples {:.6g} s apart; positions rounded by at most {:.3g} m\n",
        options.pc2, report.num_bodies, report.num_samples, report.frame_interval,
        report.largest_rounding);
}

void write_vtp_series(const scenes::RecordingReader& reader, const ExportOptions& options) {
  const output::OutputFolder folder = scenes::vtp_folder(options.vtp);
  ProgressBar progress("vtp");
  const int files =
      scenes::export_vtp_series(reader, folder, [&](double part) { progress.update(part); });
  print("{}: {} VTP files and series.pvd\n", options.vtp, files);
}

/// Says how near each cloth is, and warns of those that are farther away than was asked for.
void print_gltf(const ExportOptions& options, const scenes::GltfOptions& asked,
                const scenes::GltfExport& result, int num_frames) {
  print("{}: {} frames, {} cloths, {} rigid bodies; {:.2f} MB\n", options.gltf, num_frames,
        result.report.cloths.size(), result.report.num_rigid_bodies,
        1e-6 * static_cast<double>(result.bytes.size()));
  for (const scenes::GltfClothReport& cloth : result.report.cloths) {
    print(
        "  cloth '{}': {} morph targets; nodes at most {:.3g} mm from the recording, rms {:.3g} "
        "mm\n",
        cloth.name, cloth.num_targets, 1e3 * cloth.largest_error, 1e3 * cloth.rms_error);
  }
  if (!result.report.left_out.empty()) {
    print("  left out: {}\n", fmt::format("{}", fmt::join(result.report.left_out, ", ")));
  }
  for (const scenes::GltfClothReport& cloth : result.report.cloths) {
    if (cloth.is_within_error) continue;
    print(stderr,
          "warning: {}: cloth '{}' is up to {:.3g} mm from the recording with {} morph targets, "
          "expected at most {:.3g} mm (--gltf-error)\n",
          options.gltf, cloth.name, 1e3 * cloth.largest_error, cloth.num_targets,
          1e3 * asked.error);
  }
}

scenes::GltfOptions gltf_options(const ExportOptions& options) {
  scenes::GltfOptions asked;
  if (options.gltf_error.empty()) return asked;
  if (options.gltf.empty()) {
    throw InvalidArgument("export: --gltf-error without --gltf, expected the file to write");
  }
  asked.error = quantity_option("--gltf-error", options.gltf_error, "m");
  if (!(asked.error > 0.0) || !std::isfinite(asked.error)) {
    throw InvalidArgument(fmt::format("--gltf-error = {} [m], expected > 0", options.gltf_error));
  }
  return asked;
}

void write_gltf(const scenes::RecordingReader& reader, const ExportOptions& options) {
  const output::OutputFile output(options.gltf, scenes::kGlbKind);
  const scenes::GltfOptions asked = gltf_options(options);
  const scenes::GltfExport result = [&] {
    ProgressBar progress("gltf");
    return scenes::export_gltf(reader, asked, [&](double part) { progress.update(part); });
  }();
  output.write(result.bytes);
  print_gltf(options, asked, result, reader.num_frames());
}

/// Files for other programs, of one recording.
int export_files(const ExportOptions& options) {
  if (!options.page.empty() || !options.player.empty()) {
    throw InvalidArgument("export: --gltf, --pc2 or --vtp with a page, expected one or the other");
  }
  if (options.recordings.size() != 1) {
    throw InvalidArgument(
        fmt::format("export: {} recordings with --gltf, --pc2 or --vtp, expected one",
                    options.recordings.size()));
  }
  const std::string& file = options.recordings.front();
  const scenes::RecordingReader reader(file);
  if (reader.num_frames() == 0) throw Error(file + ": has no frame to export");
  note_if_partial(reader, file);
  try {
    if (!options.gltf.empty()) write_gltf(reader, options);
    if (!options.pc2.empty()) write_point_caches(reader, options);
  } catch (const scenes::UnfitRecording& error) {
    throw Error(file + ": " + error.what());
  }
  if (!options.vtp.empty()) write_vtp_series(reader, options);
  return kOk;
}

int export_pages(const ExportOptions& options) {
  if (options.page.empty() && options.player.empty()) {
    throw InvalidArgument(
        "export: expected --html OUT.html RECORDING, --player OUT.html, --gltf FILE.glb RECORDING, "
        "--pc2 FOLDER RECORDING or --vtp FOLDER RECORDING");
  }
  if (options.page.empty() != options.recordings.empty()) {
    throw InvalidArgument(options.page.empty()
                              ? "export: recordings without --html, expected the page to write"
                              : "export: --html without a recording, expected at least one");
  }
  std::vector<output::OutputFile> outputs;
  for (const std::string& file : {options.page, options.player}) {
    if (!file.empty()) outputs.emplace_back(file, scenes::kPlayerPageKind);
  }
  if (!options.page.empty()) {
    std::vector<scenes::PageRecording> recordings;
    for (const std::string& file : options.recordings) {
      recordings.push_back(packed(file, options));
    }
    write_page(outputs.front(), recordings);
  }
  if (!options.player.empty()) write_page(outputs.back(), {});
  return kOk;
}

}  // namespace

Action add_export_command(CLI::App& parser) {
  CLI::App* command = parser.add_subcommand(
      "export", "Write a page that plays recordings in any browser, or files for other programs");
  auto options = std::make_shared<ExportOptions>();
  command->add_option("RECORDING", options->recordings,
                      "Recordings made by `weft run`; several are played together");
  command->add_option("--html", options->page, "Page to write, with the recordings inside");
  command->add_option("--player", options->player,
                      "Page to write that has no recording: drop recordings on it");
  command->add_option("--error", options->error,
                      "By how much rounding may move a coordinate, e.g. \"0.01 mm\" (default: "
                      "1/100,000 of the largest cloth, rounded down)");
  command->add_option(
      "--pc2", options->pc2,
      "Folder to write: BODY.obj at rest and BODY.pc2, its positions in each frame, "
      "as Blender's modifier Mesh Cache reads them");
  command->add_option(
      "--vtp", options->vtp,
      "Folder to write: a VTP file for each body and frame with velocity, mass, pins "
      "and strain, and series.pvd with the times, as ParaView reads them");
  command->add_option(
      "--gltf", options->gltf,
      "File to write, FILE.glb: cloths with morph targets, rigid bodies, the camera and one "
      "animation, as Blender, game engines and viewers read it");
  command->add_option(
      "--gltf-error", options->gltf_error,
      "By how much a node may be elsewhere than in the recording, e.g. \"0.5 mm\" (default: 1 mm). "
      "The smallest number of morph targets is taken that reaches it, at most 64; if they do not, "
      "a warning says how near they come, and the exit code is 0");
  return [options] {
    (void)gltf_options(*options);
    const bool for_programs =
        !options->gltf.empty() || !options->pc2.empty() || !options->vtp.empty();
    return for_programs ? export_files(*options) : export_pages(*options);
  };
}

}  // namespace weft::app
