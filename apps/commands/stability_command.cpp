#include <filesystem>
#include <memory>
#include <string>

#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include <weft/scenes/catalog.hpp>
#include <weft/validation/report/write.hpp>
#include <weft/validation/stability/stability_map.hpp>

#include "apps/app.hpp"
#include "apps/terminal.hpp"

namespace weft::app {
namespace {

struct StabilityOptions {
  std::string scene;
  std::string output = "weft-stability";
};

int map_scene(const StabilityOptions& options) {
  const scenes::Scene scene = scenes::load_scene(options.scene);
  const output::OutputFolder folder = validation::report_folder(options.output);
  validation::Report report;
  report.title = "Stable time steps of " + scene.name;
  report.limits = {
      "Modified Euler around the rest shape: a stretched or folded cloth, and contact, may allow "
      "less."};
  report.provenance = {{"scene", scene.name}, {"program", "weft stability"}};
  for (const validation::StabilityMap& map : validation::map_stability(scene)) {
    print("cloth '{}'\n{:>10} {:>6} {:>14} {:>14} {:>8}\n", map.cloth, "stiffness", "beta",
          "predicted [s]", "measured [s]", "ratio");
    for (const validation::StabilityPoint& point : map.points) {
      print("{:>10} {:>6g} {:>14.5g} {:>14.5g} {:>8.4f}\n",
            fmt::format("x {:g}", point.stiffness_factor), point.beta, point.predicted,
            point.measured, point.measured / point.predicted);
    }
    report.checks.push_back(validation::stability_check(map));
    report.sections.push_back(validation::stability_section(map));
  }
  validation::write_report(report, folder);
  print("Map: {}\n", (std::filesystem::path(options.output) / "index.html").string());
  return report.passed() ? kOk : kCaseFailed;
}

}  // namespace

Action add_stability_command(CLI::App& parser) {
  CLI::App* command = parser.add_subcommand(
      "stability", "Map the largest stable time step over stiffness and acceleration damping");
  auto options = std::make_shared<StabilityOptions>();
  command->add_option("SCENE", options->scene, "Name from `weft list`, or a scene file")
      ->required();
  command->add_option("-o,--output", options->output, "Folder of the map")->capture_default_str();
  return [options] { return map_scene(*options); };
}

}  // namespace weft::app
