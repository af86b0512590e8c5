#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include <weft/engines/engine_table.hpp>
#include <weft/validation/cases.hpp>
#include <weft/validation/cases/support/parameters.hpp>
#include <weft/validation/referee/judged_cases.hpp>
#include <weft/validation/report/write.hpp>
#include <weft/validation/suite.hpp>

#include "apps/app.hpp"
#include "apps/hand_over.hpp"
#include "apps/judged_scenes.hpp"
#include "apps/progress/partial_note.hpp"
#include "apps/progress/progress_bar.hpp"
#include "apps/progress/progress_lines.hpp"
#include "apps/provenance.hpp"
#include "apps/terminal.hpp"

namespace weft::app {
namespace {

struct ValidateOptions {
  std::vector<std::string> cases;
  std::string output = "weft-report";
  int jobs = 0;
  bool no_pictures = false;
  bool render_only = false;
  bool quick = false;
  bool all = false;
  bool list = false;
  std::string engine;
  std::string recording;
  std::string scenes_folder;
  validation::CaseValues values;
};

std::string page_path(const ValidateOptions& options) {
  return (std::filesystem::absolute(options.output) / "index.html").lexically_normal().string();
}

int list_cases(const validation::SuiteOptions& suite) {
  for (const validation::CaseInfo* info : validation::chosen_cases(suite)) {
    print("{}", validation::describe(*info));
  }
  return kOk;
}

/// What run_suite() tells, as a bar for a terminal and as lines for a log.
class SuiteProgress {
 public:
  explicit SuiteProgress(int num_cases) : num_cases_(num_cases) {}
  ~SuiteProgress() { end_case(); }
  SuiteProgress(const SuiteProgress&) = delete;
  SuiteProgress& operator=(const SuiteProgress&) = delete;

  /// what: "run LABEL" after a simulation, "judge CASE" before a case.
  void update(const std::string& what, double fraction) {
    const std::size_t blank = what.find(' ');
    const std::string stage = what.substr(0, blank);
    const std::string name = what.substr(blank + 1);
    if (stage != stage_) bar_.emplace(stage);
    stage_ = stage;
    bar_->update(fraction);
    if (stage == "run") {
      ++num_runs_;
      // The fraction is exact up to rounding, and so their number is.
      lines_.done("run", num_runs_, static_cast<int>(std::lround(num_runs_ / fraction)), name);
    } else {
      end_case();
      case_ = name;
    }
  }

 private:
  void end_case() {
    if (!case_.empty()) lines_.done("case", ++num_judged_, num_cases_, case_);
    case_.clear();
  }

  ProgressLines lines_;
  std::optional<ProgressBar> bar_;
  std::string stage_;
  std::string case_;  ///< that is being judged
  int num_cases_;
  int num_judged_ = 0;
  int num_runs_ = 0;
};

/// Puts the recording in the place of the engines, and its case in that of the cases.
void judge_recording(const ValidateOptions& options, validation::SuiteOptions& suite) {
  if (!options.values.empty()) {
    throw InvalidArgument(
        fmt::format("--recording {}: with --{}, expected no parameter: a recording "
                    "is of one scene",
                    options.recording, options.values.begin()->first));
  }
  validation::RecordedResult recorded = validation::recorded_result(options.recording);
  if (!options.engine.empty()) recorded.judged_as = options.engine;
  suite.case_ids = {std::string(validation::case_of_recording(options.cases, recorded).id)};
  suite.cases.engine.clear();
  suite.cases.recorded = std::move(recorded);
}

/// Adds the recording's file, its content hash and where it comes from to the report.
void add_provenance(const std::string& file, validation::Report& report) {
  const scenes::RecordingReader reader(file);
  note_if_partial(reader, file);
  report.provenance.emplace_back("recording", file);
  report.provenance.emplace_back("recording content hash", reader.content_hash());
  for (const auto& [key, value] : reader.provenance()) {
    report.provenance.emplace_back("recording " + key, value);
  }
}

int validate(const ValidateOptions& options, const CommandLine& command_line) {
  const bool with_bullet = scenes::bullet_description() != "none";
  validation::SuiteOptions suite;
  suite.weft = executable_for(command_line, scenes::StoredPrecision::kFloat32);
  suite.case_ids = options.cases;
  suite.jobs = options.jobs > 0
                   ? options.jobs
                   : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  suite.quick = options.quick;
  suite.cases = {.pictures = !options.no_pictures,
                 .bullet = with_bullet,
                 .values = options.values,
                 .engine = options.engine};
  if (!options.recording.empty()) judge_recording(options, suite);
  if (options.list) return list_cases(suite);

  const int num_cases = static_cast<int>(validation::chosen_cases(suite).size());
  const output::OutputFolder folder = validation::report_folder(options.output);
  suite.folder = folder.make_folder("runs");
  validation::Report report;
  {
    SuiteProgress progress(num_cases);
    report = validation::run_suite(
        suite, [&](const std::string& what, double fraction) { progress.update(what, fraction); });
  }
  for (const auto& [key, value] : build_provenance()) report.provenance.emplace_back(key, value);
  if (suite.cases.recorded) add_provenance(options.recording, report);
  validation::write_report(report, folder);
  print("{}", validation::to_text(report));
  if (suite.cases.recorded) {
    for (const std::string& text : validation::not_judged_texts()) print("{}\n", text);
  }
  print("Report: {}\n", page_path(options));
  return report.passed() ? kOk : kCaseFailed;
}

int write_scenes(const ValidateOptions& options) {
  const int count = write_judged_scenes(judged_scenes_folder(options.scenes_folder));
  print("{}: {} scenes, each with an OBJ file for every body\n", options.scenes_folder, count);
  return kOk;
}

int render_again(const ValidateOptions& options) {
  validation::render_report(options.output);
  print("Report: {}\n", page_path(options));
  return kOk;
}

/// An option for every name that some case has a parameter of.
void add_parameters(CLI::App& command, validation::CaseValues& values) {
  std::map<std::string_view, std::string> cases_of;
  for (const validation::CaseInfo& info : validation::all_cases()) {
    for (const validation::CaseParameter& parameter : info.parameters) {
      std::string& cases = cases_of[parameter.name];
      cases += (cases.empty() ? "" : ", ") + std::string(info.id);
    }
  }
  for (const auto& [name, cases] : cases_of) {
    command
        .add_option_function<double>(
            fmt::format("--{}", name),
            [&values, name = std::string(name)](const double& value) { values[name] = value; },
            "of " + cases)
        ->group(
            "One point of one case in place of its table (validate CASE --list tells units and "
            "ranges)");
  }
}

}  // namespace

Action add_validate_command(CLI::App& parser, const CommandLine& command_line) {
  CLI::App* command = parser.add_subcommand(
      "validate", "Compare every engine with the reference and with theory, write a report");
  auto options = std::make_shared<ValidateOptions>();
  std::string known;
  for (const validation::CaseInfo& info : validation::all_cases()) {
    known += (known.empty() ? "" : ", ") + std::string(info.id);
  }
  CLI::Option* names =
      command->add_option("CASE", options->cases, "Which cases (default: all): " + known);
  command->add_option("-o,--output", options->output, "Folder of the report")
      ->capture_default_str();
  command->add_option("-j,--jobs", options->jobs, "Simulations at a time (default: one per core)")
      ->check(CLI::Range(1, 1024));
  command->add_flag("--no-pictures", options->no_pictures, "Numbers and plots only");
  CLI::Option* render = command->add_flag(
      "--render-only", options->render_only,
      "Run nothing: write index.html anew from the report.json in the folder of --output");
  render->excludes(names);
  CLI::Option* quick =
      command->add_flag("--quick", options->quick, "Only the cases of the commit tier: minutes");
  quick->excludes(names);
  command->add_flag("--all", options->all, "Every case: as without --quick")->excludes(quick);
  command->add_flag("--list", options->list, "Show the cases with their parameters and stop");
  command->add_option("-e,--engine", options->engine,
                      "Only this engine, of one case: reference, bullet_weft, bullet_forces. With "
                      "--recording: whose bounds hold (default bullet_weft)");
  command
      ->add_option(
          "--recording", options->recording,
          "Judge this recording in place of an engine, by the case of its scene or by CASE; "
          "what it cannot show is listed as not judged")
      ->excludes(quick)
      ->excludes(render);
  command
      ->add_option("--write-scenes", options->scenes_folder,
                   "Run nothing: write the scenes that --recording can judge into this folder, for "
                   "other programs, as scene files and OBJ files")
      ->excludes(names)
      ->excludes(render);
  add_parameters(*command, options->values);
  return [options, command_line] {
    if (!options->scenes_folder.empty()) return write_scenes(*options);
    return options->render_only ? render_again(*options) : validate(*options, command_line);
  };
}

}  // namespace weft::app
