#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include <weft/custom_forces/core/error.hpp>
#include <weft/scenes/playback/renderer.hpp>
#include <weft/scenes/quantity.hpp>
#include <weft/scenes/recording/recording.hpp>

#include "apps/app.hpp"
#include "apps/progress_bar.hpp"

namespace weft::app {
namespace {

struct RenderCommandOptions {
  std::string recording;
  std::string output;
  std::string style = "shaded";
  std::string time;
  bool all = false;
  scenes::RenderOptions render;
};

int frame_at(const scenes::RecordingReader& reader, const std::string& time) {
  if (time.empty()) return reader.num_frames() - 1;
  double seconds = 0;
  try {
    seconds = scenes::parse_quantity(time, "s");
  } catch (const scenes::UnitError& error) {
    throw InvalidArgument(fmt::format("--time \"{}\": {}", time, error.what()));
  }
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
    values.push_back(
        100 * scenes::node_strain(scenes::make_mesh(scene.cloths[c]), state.cloths[c].positions));
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

int render(RenderCommandOptions options) {
  const scenes::RecordingReader reader(options.recording);
  std::error_code none;
  if (std::filesystem::equivalent(options.recording, options.output, none)) {
    throw InvalidArgument(options.output + ": is the recording itself, expected another --output");
  }
  if (options.all && !options.time.empty()) {
    throw InvalidArgument("--time with --all: one frame or every frame, expected one of the two");
  }
  if (reader.num_frames() == 0) throw Error(options.recording + ": has no frame to render");
  const bool strain = options.style == "strain";
  options.render.style = strain                         ? scenes::SurfaceStyle::kScalar
                         : options.style == "wireframe" ? scenes::SurfaceStyle::kWireframe
                                                        : scenes::SurfaceStyle::kShaded;
  scenes::ScalarField field;
  if (strain) field = strain_scale(reader);
  scenes::Renderer renderer(reader.scene());
  const auto draw = [&](int frame, const std::filesystem::path& path) {
    const scenes::SceneState state = reader.frame(frame);
    if (strain) field.values = strains_percent(reader.scene(), state);
    scenes::write_png(path, renderer.render(state, options.render, strain ? &field : nullptr));
  };
  if (!options.all) {
    const int frame = frame_at(reader, options.time);
    draw(frame, options.output);
    fmt::print("{}: t = {:.4g} s\n", options.output, reader.frame_time(frame));
    return kOk;
  }
  std::filesystem::create_directories(options.output);
  {
    ProgressBar progress("render");
    for (int frame = 0; frame < reader.num_frames(); ++frame) {
      progress.update(static_cast<double>(frame) / reader.num_frames());
      draw(frame, std::filesystem::path(options.output) / fmt::format("frame_{:05}.png", frame));
    }
  }
  fmt::print("{}: {} pictures\n", options.output, reader.num_frames());
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
  command->add_option("--style", options->style, "How cloth looks")
      ->check(CLI::IsMember({"shaded", "wireframe", "strain"}))
      ->capture_default_str();
  command->add_option("--time", options->time,
                      "Nearest frame to this time, e.g. \"1.5 s\" (default: last)");
  command->add_flag("--all", options->all, "Every frame, as frame_00000.png ... in a folder");
  command->add_option("--width", options->render.width, "[pixels]")->capture_default_str();
  command->add_option("--height", options->render.height, "[pixels]")->capture_default_str();
  return [options] { return render(*options); };
}

}  // namespace weft::app
