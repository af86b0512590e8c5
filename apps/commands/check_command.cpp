#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <weft/core/error.hpp>
#include <weft/scenes/engine_kind.hpp>
#include <weft/scenes/format/scene_file.hpp>
#include <weft/scenes/scene_warnings.hpp>

#include "apps/app.hpp"
#include "apps/terminal.hpp"

namespace weft::app {
namespace {

struct CheckOptions {
  std::vector<std::string> files;
  bool resolved = false;
};

/// For the engines that the scene is made for, in single precision, which most have.
void warn(const std::string& file, const scenes::Scene& scene) {
  const std::vector<std::string> engines = scenes::engine_names(
      [&](const scenes::EngineKind& kind) { return scenes::is_for_engine(scene, kind.name); });
  for (const scenes::SceneWarning& found : scenes::find_warnings(scene, engines, true)) {
    const std::string list = fmt::format("{}", fmt::join(found.engines, ", "));
    print(stderr, "warning: {}: cloth '{}': {} ({})\n", file, found.cloth, found.warning.message,
          list);
  }
}

int check(const CheckOptions& options) {
  int exit_code = kOk;
  for (const std::string& file : options.files) {
    try {
      const scenes::Scene scene = scenes::read_scene_file(file);
      for (const scenes::Cloth& cloth : scene.cloths) (void)scenes::make_mesh(cloth);
      warn(file, scene);
      if (options.resolved) {
        write_data(stdout, scenes::write_scene(scene));
      } else {
        print("{}: ok, {}\n", file, scene.summary);
      }
    } catch (const InvalidArgument& error) {
      print(stderr, "weft: {}\n", error.what());
      exit_code = kBadInput;
    }
  }
  return exit_code;
}

}  // namespace

Action add_check_command(CLI::App& parser) {
  CLI::App* command = parser.add_subcommand("check",
                                            "Check scene files: errors name file, line and column, "
                                            "warnings say what will hardly do what was meant");
  auto options = std::make_shared<CheckOptions>();
  command->add_option("FILE", options->files, "Scene files (TOML)")->required();
  command->add_flag("--resolved", options->resolved,
                    "Print the scene with every default written out");
  return [options] { return check(*options); };
}

}  // namespace weft::app
