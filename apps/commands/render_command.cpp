#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include <weft/core/error.hpp>
#include <weft/playback/rendering/image.hpp>
#include <weft/playback/rendering/montage.hpp>
#include <weft/playback/rendering/renderer.hpp>
#include <weft/scenes/recording/recording.hpp>
#include <weft/scenes/torn_cloth.hpp>

#include "apps/app.hpp"
#include "apps/partial_note.hpp"
#include "apps/progress_bar.hpp"
#include "apps/quantity_option.hpp"
#include "apps/terminal.hpp"

namespace weft::app {
namespace {

struct RenderCommandOptions {
  std::string recording;
  std::string output;
  std::vector<std::string> styles = {"shaded"};
  std::string time;
  std::vector<std::string> times;
  int columns = 0;
  std::string size;
  bool all = false;
  scenes::RenderOptions render;
};

int frame_at(const scenes::RecordingReader& reader, const char* option, const std::string& time) {
  const double seconds = quantity_option(option, time, "s");
  int best = 0;
  for (int f = 0; f < reader.num_frames(); ++f) {
    if (std::abs(reader.frame_time(f) - seconds) < std::abs(reader.frame_time(best) - seconds))
      best = f;
  }
  return best;
}

std::vector<Eigen::VectorXd> strains_percent(const scenes::Scene& scene,
                                             const scenes::SceneState& state) {
  std::vector<Eigen::VectorXd> values;
  for (std::size_t c = 0; c < scene.cloths.size(); ++c) {
    const scenes::ClothState& cloth = state.cloths[c];
    const ClothMesh mesh =
        scenes::drawn_mesh(scenes::make_mesh(scene.cloths[c]), cloth.topology.get());
    values.push_back(100 * scenes::node_strain(mesh, cloth.positions));
  }
  return values;
}

/// One scale for all frames: that of the last one, where most scenes carry their full load.
scenes::ScalarField strain_scale(const scenes::RecordingReader& reader) {
  scenes::ScalarField field;
  field.label = "strain [%]";
  double largest = 0;
  for (const Eigen::VectorXd& values :
       strains_percent(reader.scene(), reader.frame(reader.num_frames() - 1))) {
    largest = std::max(largest, values.cwiseAbs().maxCoeff());
  }
  field.maximum = largest > 0 && std::isfinite(largest) ? largest : 1.0;
  field.minimum = -field.maximum;
  return field;
}

/// Draws frames of one recording in any style.
class Film {
 public:
  Film(const scenes::RecordingReader& reader, const scenes::RenderOptions& options)
      : reader_(reader), options_(options), renderer_(reader.scene()) {}

  scenes::Image draw(int frame, const std::string& style) {
    const scenes::SceneState state = reader_.frame(frame);
    if (style != "strain") {
      options_.style =
          style == "wireframe" ? scenes::SurfaceStyle::kWireframe : scenes::SurfaceStyle::kShaded;
      return renderer_.render(state, options_);
    }
    if (!field_) field_ = strain_scale(reader_);
    field_->values = strains_percent(reader_.scene(), state);
    options_.style = scenes::SurfaceStyle::kScalar;
    return renderer_.render(state, options_, &*field_);
  }

 private:
  const scenes::RecordingReader& reader_;
  scenes::RenderOptions options_;
  scenes::Renderer renderer_;
  std::optional<scenes::ScalarField> field_;
};

void read_size(const std::string& text, scenes::RenderOptions& options) {
  if (text.empty()) return;
  const std::size_t cross = text.find('x');
  const auto number = [&](const std::string& part, int& value) {
    const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), value);
    return error == std::errc() && end == part.data() + part.size();
  };
  if (cross == std::string::npos || !number(text.substr(0, cross), options.width) ||
      !number(text.substr(cross + 1), options.height)) {
    throw InvalidArgument(fmt::format("--size {}: expected pixels such as 960x540", text));
  }
}

void check_options(const RenderCommandOptions& options, const scenes::RecordingReader& reader) {
  const int choices = int{options.all} + int{!options.time.empty()} + int{!options.times.empty()};
  if (choices > 1) {
    throw InvalidArgument("--time, --times, --all: expected at most one of them");
  }
  if (options.all && options.styles.size() > 1) {
    throw InvalidArgument("--all with several styles: expected one --style");
  }
  if (reader.num_frames() == 0) throw Error(options.recording + ": has no frame to render");
}

/// One picture for every time and style, side by side; columns = 0: a row for each style.
int render_strip(const RenderCommandOptions& options, const scenes::RecordingReader& reader) {
  const output::OutputFile output(options.output, scenes::kPictureKind);
  std::vector<int> frames;
  for (const std::string& time : options.times) frames.push_back(frame_at(reader, "--times", time));
  if (!options.time.empty()) frames.push_back(frame_at(reader, "--time", options.time));
  if (frames.empty()) frames.push_back(reader.num_frames() - 1);
  Film film(reader, options.render);
  std::vector<scenes::Image> pictures;
  for (const std::string& style : options.styles) {
    for (const int frame : frames) {
      pictures.push_back(film.draw(frame, style));
      if (frames.size() == 1) continue;
      scenes::draw_label(pictures.back(), fmt::format("t = {:.4g} s", reader.frame_time(frame)));
    }
  }
  const int row = static_cast<int>(frames.size() == 1 ? options.styles.size() : frames.size());
  const bool is_single = pictures.size() == 1;
  output.write(scenes::encode_png(
      is_single ? pictures.front()
                : scenes::filmstrip(pictures, options.columns ? options.columns : row)));
  std::string times;
  for (const int frame : frames) {
    times += fmt::format("{}{:.4g} s", times.empty() ? "" : ", ", reader.frame_time(frame));
  }
  print("{}: t = {}\n", options.output, times);
  return kOk;
}

/// A file for every frame, all looked at before the first is drawn.
std::vector<output::OutputFile> frame_files(const std::filesystem::path& folder, int num_frames) {
  if (std::filesystem::is_symlink(folder)) {
    throw InvalidArgument(folder.string() + ": is a symbolic link, expected a folder");
  }
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw Error(folder.string() + ": cannot be made (" + error.message() + ")");
  std::vector<output::OutputFile> files;
  for (int frame = 0; frame < num_frames; ++frame) {
    files.emplace_back(folder / fmt::format("frame_{:05}.png", frame), scenes::kPictureKind);
  }
  return files;
}

int render(RenderCommandOptions options) {
  const scenes::RecordingReader reader(options.recording);
  read_size(options.size, options.render);
  check_options(options, reader);
  note_if_partial(reader, options.recording);
  if (!options.all) return render_strip(options, reader);
  Film film(reader, options.render);
  const std::vector<output::OutputFile> outputs = frame_files(options.output, reader.num_frames());
  {
    ProgressBar progress("render");
    for (int frame = 0; frame < reader.num_frames(); ++frame) {
      progress.update(static_cast<double>(frame) / reader.num_frames());
      outputs[static_cast<std::size_t>(frame)].write(
          scenes::encode_png(film.draw(frame, options.styles.front())));
    }
  }
  print("{}: {} pictures\n", options.output, reader.num_frames());
  return kOk;
}

}  // namespace

Action add_render_command(CLI::App& parser) {
  CLI::App* command =
      parser.add_subcommand("render", "Draw a recording off-screen, without a display");
  auto options = std::make_shared<RenderCommandOptions>();
  command->add_option("RECORDING", options->recording, "Recording made by `weft run`")->required();
  command->add_option("-o,--output", options->output, "PNG to write; with --all a folder")
      ->required();
  command
      ->add_option("--style", options->styles,
                   "How cloth looks; several, as in shaded,wireframe, side by side")
      ->delimiter(',')
      ->check(CLI::IsMember({"shaded", "wireframe", "strain"}))
      ->capture_default_str();
  command->add_option("--time", options->time,
                      "Nearest frame to this time, e.g. \"1.5 s\" (default: last)");
  command
      ->add_option("--times", options->times,
                   "Several frames in one picture, e.g. \"0 s,0.5 s,1 s\", each with its time")
      ->delimiter(',');
  command
      ->add_option("--columns", options->columns, "Of several pictures (default: a row each style)")
      ->check(CLI::Range(1, 100));
  command->add_flag("--all", options->all, "Every frame, as frame_00000.png ... in a folder");
  auto* width = command->add_option("--width", options->render.width, "[pixels]");
  auto* height = command->add_option("--height", options->render.height, "[pixels]");
  width->capture_default_str();
  height->capture_default_str();
  command->add_option("--size", options->size, "Both at once, e.g. 960x540 [pixels]")
      ->excludes(width)
      ->excludes(height);
  return [options] { return render(*options); };
}

}  // namespace weft::app
