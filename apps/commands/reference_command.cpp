#include <memory>
#include <optional>
#include <string>

#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include <weft/core/error.hpp>
#include <weft/scenes/catalog.hpp>
#include <weft/scenes/format/scene_words.hpp>
#include <weft/scenes/output/output_file.hpp>
#include <weft/validation/converged/converged_reference.hpp>

#include "apps/app.hpp"
#include "apps/provenance.hpp"
#include "apps/quantity_option.hpp"
#include "apps/terminal.hpp"

namespace weft::app {
namespace {

struct ReferenceOptions {
  std::string scene;
  std::string time = "0.5 s";
  int levels = 4;
  int division = 1;
  double gate = 0.01;
  std::string output;
};

std::string shown(const std::optional<double>& value) {
  return value ? fmt::format("{:.3g}", *value) : "-";
}

void print_study(const validation::ConvergedReference& reference) {
  print("{} at {:g} s; differences as a part of {:g} m\n", reference.scene, reference.time,
        reference.size);
  for (const validation::ConvergenceStudy& study : reference.studies) {
    const auto word = static_cast<std::size_t>(study.integrator);
    print("{}\n{:>12} {:>10} {:>12}\n", scenes::kIntegratorWords[word], "step [s]", "steps",
          "difference");
    for (const validation::ConvergenceLevel& level : study.levels) {
      print("{:>12.6g} {:>10} {:>12} {}\n", level.time_step, level.num_steps,
            shown(level.difference), level.blow_up.value_or(""));
    }
    print("  observed order {}, of {}; GCI {}, a tenth of the gate is {:g}\n", shown(study.order),
          study.formal_order, shown(study.gci), reference.gate / 10);
  }
  print("The integrators are {} apart, a third of the gate is {:.3g}.\n{}\n",
        shown(reference.agreement), reference.gate / 3,
        reference.is_converged() ? "Converged." : "NOT converged.");
}

int make_reference_data(const ReferenceOptions& options) {
  const scenes::Scene scene = scenes::load_scene(options.scene);
  // Before minutes of work.
  std::optional<output::OutputFile> file;
  if (!options.output.empty()) file.emplace(options.output, validation::kReferenceKind);
  validation::ConvergedReference reference =
      validation::converge(scene, {.time = quantity_option("--time", options.time, "s"),
                                   .num_levels = options.levels,
                                   .first_division = options.division,
                                   .gate = options.gate});
  const scenes::Provenance made = build_provenance();
  reference.program =
      fmt::format("weft {} {}, {}", made.at("weft"), made.at("revision"), made.at("compiler"));
  print_study(reference);
  if (file) file->write(validation::to_json(reference));
  return reference.is_converged() ? kOk : kCaseFailed;
}

}  // namespace

Action add_reference_command(CLI::App& parser) {
  CLI::App* command = parser.add_subcommand(
      "reference", "Run a scene to convergence with two integrators, and store how far it is");
  auto options = std::make_shared<ReferenceOptions>();
  command->add_option("SCENE", options->scene, "Name from `weft list`, or a scene file")
      ->required();
  command->add_option("--time", options->time, "Simulated time to compare at, such as \"0.5 s\"")
      ->capture_default_str();
  command->add_option("--levels", options->levels, "Number of time steps h, h/2, h/4 ...")
      ->capture_default_str();
  command
      ->add_option("--division", options->division,
                   "h is the scene's time step divided by this number")
      ->capture_default_str();
  command
      ->add_option("--gate", options->gate,
                   "Distance that the reference shall judge, as a part of the cloth's size")
      ->capture_default_str();
  command->add_option("-o,--output", options->output, "JSON file of the reference");
  return [options] { return make_reference_data(*options); };
}

}  // namespace weft::app
