#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include <weft/core/error.hpp>
#include <weft/engines/engine_table.hpp>
#include <weft/scenes/engine_kind.hpp>
#include <weft/scenes/output/output_file.hpp>
#include <weft/validation/contact_table/contact_table.hpp>

#include "apps/app.hpp"
#include "apps/progress/progress_bar.hpp"
#include "apps/terminal.hpp"

namespace weft::app {
namespace {

struct TableOptions {
  std::string engine{scenes::kBulletSoft.name};
  std::string markdown;
  std::string csv;
};

/// Looked at before the work is done; none if no path is given.
std::optional<output::OutputFile> output_at(const std::string& path, const output::FileKind& kind) {
  if (path.empty()) return std::nullopt;
  return output::OutputFile(path, kind);
}

int make_table(const TableOptions& options) {
  // This program's own precision: Bullet's other one lives in another executable.
  const scenes::EngineInfo* engine = nullptr;
  for (const scenes::EngineInfo& one : scenes::engine_table()) {
    if (one.name == options.engine) engine = &one;
  }
  if (engine == nullptr) {
    throw InvalidArgument("contact-table: engine = '" + options.engine +
                          "': this program was built without Bullet");
  }
  const auto markdown = output_at(options.markdown, validation::kContactMarkdownKind);
  const auto csv = output_at(options.csv, validation::kContactCsvKind);
  const std::unique_ptr<scenes::Simulator> simulator = engine->make();
  const std::vector<validation::ContactTarget> targets = validation::contact_targets();
  std::vector<validation::ContactRow> rows;
  ProgressBar progress("contact table");
  const std::size_t count =
      targets.size() * validation::kTableTimeSteps.size() * validation::kTableSpeeds.size();
  for (const validation::ContactTarget& target : targets) {
    for (const double time_step : validation::kTableTimeSteps) {
      for (const double speed : validation::kTableSpeeds) {
        rows.push_back(validation::measure_contact(*simulator, target, time_step, speed));
        progress.update(static_cast<double>(rows.size()) / static_cast<double>(count));
      }
    }
  }
  const std::string name =
      fmt::format("`{}`, {}", engine->name, scenes::to_string(engine->precision));
  const std::string table = validation::contact_markdown(rows, name);
  if (markdown) markdown->write(table);
  if (csv) csv->write(validation::contact_csv(rows));
  if (options.markdown.empty()) print("\n{}", table);
  return kOk;
}

}  // namespace

Action add_contact_table_command(CLI::App& parser) {
  CLI::App* command = parser.add_subcommand(
      "contact-table",
      "Throw a cloth at every kind of collider: how deep its nodes go, how many pass");
  auto options = std::make_shared<TableOptions>();
  command->add_option("-e,--engine", options->engine, "Which engine simulates")
      ->check(CLI::IsMember(scenes::engine_names(
          [](const scenes::EngineKind& kind) { return kind.uses_bullet && !kind.is_deformable; })))
      ->capture_default_str();
  command->add_option("-o,--out", options->markdown, "Write the table here, as Markdown");
  command->add_option("--csv", options->csv, "Write every run here, one line each");
  return [options] { return make_table(*options); };
}

}  // namespace weft::app
