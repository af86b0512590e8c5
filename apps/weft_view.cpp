// The window of `weft view`: parse, open, say what went wrong.
#include <charconv>
#include <exception>
#include <new>
#include <string>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <weft/core/error.hpp>
#include <weft/core/input_file.hpp>
#include <weft/engines/engine_table.hpp>
#include <weft/viewer/ui/viewer_window.hpp>

#include "apps/app.hpp"
#include "apps/provenance.hpp"
#include "apps/terminal.hpp"

namespace {

using namespace weft;

constexpr const char* kFooter = R"(Examples:
  weft view drape_sphere                 simulate a scene of the catalog
  weft view my_scene.toml                it is read again whenever it is saved
  weft view a.weftrec b.weftrec          play recordings over one another

F1 in the window lists all keys. Ctrl and drag pulls at the cloth.)";

struct Options {
  std::vector<std::string> files;
  std::string engine;
  std::string precision;
  std::string style = "shaded";
  std::string size;
  std::string record;
  std::string script;
  std::string state;
  double scale = 0.0;
  double speed = 1.0;
  bool paused = false;
  bool exit_at_end = false;
};

viewer::WindowSize read_size(const std::string& text) {
  constexpr int kSmallest = 200;  // [screen unit]
  constexpr int kLargest = 8192;
  viewer::WindowSize size;
  const std::size_t cross = text.find('x');
  const auto number = [&](std::size_t from, std::size_t to, int& value) {
    const auto [end, error] = std::from_chars(text.data() + from, text.data() + to, value);
    return error == std::errc() && end == text.data() + to && value >= kSmallest &&
           value <= kLargest;
  };
  if (cross == std::string::npos || !number(0, cross, size.width) ||
      !number(cross + 1, text.size(), size.height)) {
    throw InvalidArgument(fmt::format("--size {}: expected pixels such as 1280x800, {} to {} each",
                                      text, kSmallest, kLargest));
  }
  return size;
}

void add_options(CLI::App& parser, Options& options) {
  std::vector<std::string> engines;
  for (const scenes::EngineInfo& engine : scenes::engine_table()) {
    engines.emplace_back(engine.name);
  }
  parser.add_option("FILE", options.files,
                    "Scenes (catalog names or files), or recordings to show over one another "
                    "(default: drape_sphere)");
  parser
      .add_option("-e,--engine", options.engine,
                  "Which engine simulates (default: the first that the scene names, else the "
                  "reference)")
      ->check(CLI::IsMember(engines));
  parser.add_option("-p,--precision", options.precision,
                    "float32 or float64, of Bullet (default float32); chooses the program");
  parser.add_option("--style", options.style, "How cloth looks at first")
      ->check(CLI::IsMember({"shaded", "wireframe", "strain"}))
      ->capture_default_str();
  parser.add_option("--size", options.size, "Of the window, e.g. 1280x800");
  parser
      .add_option("--scale", options.scale,
                  "Of text and panels, e.g. 2 (default: as the screen asks for)")
      ->check(CLI::Range(0.5, 4.0));
  parser.add_option("--speed", options.speed, "Simulated over wall time, at most")
      ->check(CLI::Range(0.01, 1000.0))
      ->capture_default_str();
  parser.add_flag("--paused", options.paused, "Do not run at first");
  parser.add_option("--record", options.record,
                    "Write the first run to this recording, as `weft run` does");
  parser.add_flag("--exit-at-end", options.exit_at_end,
                  "Close the window once the scene's duration is simulated");
  parser.add_option("--script", options.script, "Keys and mouse from a file (docs/playback.md)");
  parser.add_option(
      "--state", options.state,
      "Write what is shown to this JSON file, at the end and whenever it is not there");
}

viewer::ViewerSettings settings_of(const Options& options) {
  if (!options.precision.empty()) {
    throw InvalidArgument("--precision " + options.precision +
                          ": chooses the program, expected it after weft view");
  }
  viewer::ViewerSettings settings;
  settings.session.files = options.files;
  settings.session.live.engine = options.engine;
  settings.session.live.record = options.record;
  settings.session.live.is_running = !options.paused;
  settings.session.live.speed = options.speed;
  settings.session.live.provenance = app::build_provenance();
  settings.session.style = options.style == "wireframe" ? scenes::SurfaceStyle::kWireframe
                           : options.style == "strain"  ? scenes::SurfaceStyle::kScalar
                                                        : scenes::SurfaceStyle::kShaded;
  if (!options.size.empty()) settings.size = read_size(options.size);
  settings.scale = options.scale;
  settings.state_file = options.state;
  settings.exits_at_end = options.exit_at_end;
  if (!options.script.empty()) {
    try {
      settings.script = viewer::Script(read_input_file(options.script), options.script);
    } catch (const InvalidArgument& error) {
      const std::string text = error.what();
      throw InvalidArgument(text.starts_with(options.script) ? text : options.script + ": " + text);
    }
  }
  return settings;
}

int run(int argc, char** argv) {
  CLI::App parser("weft view: a window that simulates scenes and plays recordings", "weft view");
  parser.footer(kFooter);
  parser.get_formatter()->column_width(36);
  Options options;
  add_options(parser, options);
  try {
    parser.parse(argc, argv);
  } catch (const CLI::Success& asked) {
    return parser.exit(asked);
  } catch (const CLI::ParseError& error) {
    app::print(stderr, "weft view: {}\nTry: weft view --help\n", error.what());
    return app::kBadInput;
  }
  viewer::run_viewer(settings_of(options));
  return app::kOk;
}

}  // namespace

int main(int argc, char** argv) {
  app::prepare_output();
  int code = app::kBadInput;
  try {
    code = run(argc, argv);
  } catch (const std::bad_alloc&) {
    app::print(stderr, "weft view: there is not enough memory\n");
  } catch (const std::exception& error) {
    app::print(stderr, "weft view: {}\n", error.what());
  }
  return app::finish_output(code);
}
