#include <weft/validation/suite.hpp>

#include <algorithm>

#include <weft/core/error.hpp>
#include <weft/scenes/engine_kind.hpp>
#include <weft/validation/cases.hpp>
#include <weft/validation/cases/support/parameters.hpp>
#include <weft/validation/deviations/known_deviations.hpp>
#include <weft/validation/referee/judged_cases.hpp>
#include <weft/validation/theory/theory_runs.hpp>

namespace weft::validation {
namespace {

/// The reference answers for itself unless another engine is asked for.
bool evaluates_itself(const CaseInfo& info, const CaseOptions& options) {
  return info.evaluate != nullptr &&
         (options.engine.empty() || options.engine == scenes::kReferenceEngine.name);
}

/// One point of a case is the reference's alone, unless an engine is named for it.
bool runs_theory(const CaseInfo& info, const CaseOptions& options) {
  if (info.theory == nullptr || options.recorded) return false;
  if (info.evaluate == nullptr) return true;
  if (!options.engine.empty()) return options.engine != scenes::kReferenceEngine.name;
  return !asks_for_point(options);
}

}  // namespace

std::vector<const CaseInfo*> chosen_cases(const SuiteOptions& options) {
  std::vector<const CaseInfo*> chosen;
  for (const std::string& id : options.case_ids) {
    const auto found = std::find_if(all_cases().begin(), all_cases().end(),
                                    [&](const CaseInfo& info) { return info.id == id; });
    if (found != all_cases().end()) {
      chosen.push_back(&*found);
      continue;
    }
    std::string known;
    for (const CaseInfo& info : all_cases()) {
      known += (known.empty() ? "" : ", ") + std::string(info.id);
    }
    throw InvalidArgument("validate: case '" + id + "' is unknown, expected one of: " + known);
  }
  const bool asks = !options.cases.values.empty() || !options.cases.engine.empty();
  if (asks && chosen.size() != 1) {
    throw InvalidArgument("validate: parameters and an engine are for one case, name it");
  }
  if (asks) check_values(*chosen[0], options.cases);
  if (options.case_ids.empty()) {
    for (const CaseInfo& info : all_cases()) {
      if (!options.quick || info.tier == Tier::kCommit) chosen.push_back(&info);
    }
  }
  return chosen;
}

Report run_suite(const SuiteOptions& options,
                 const std::function<void(const std::string& what, double fraction)>& progress) {
  const std::vector<const CaseInfo*> cases = chosen_cases(options);
  EngineRuns runs(options.weft, options.folder, options.jobs);
  for (const CaseInfo* info : cases) {
    if (info->plan) info->plan(*info, options.cases, runs);
    if (runs_theory(*info, options.cases)) plan_theory(*info, options.cases, runs);
  }
  runs.run_all(
      [&](double fraction, const std::string& label) { progress("run " + label, fraction); });

  Report report;
  report.title = "Weft validation";
  if (options.cases.recorded) {
    report.title += " of " + options.cases.recorded->path.filename().string();
  }
  double done = 0;
  for (const CaseInfo* info : cases) {
    progress("judge " + std::string(info->id), done / static_cast<double>(cases.size()));
    if (evaluates_itself(*info, options.cases)) {
      info->evaluate(*info, options.cases, runs, report);
    }
    if (runs_theory(*info, options.cases)) judge_theory(*info, options.cases, runs, report);
    ++done;
  }
  std::vector<std::string_view> judged;
  // One point, one engine or a recording is a part of a case: what was stated of the rest cannot be missed there.
  const bool is_whole = options.cases.bullet && options.cases.engine.empty() &&
                        !asks_for_point(options.cases) && !options.cases.recorded;
  for (const CaseInfo* info : cases) {
    if (is_whole) judged.push_back(info->id);
  }
  apply_deviations(known_deviations(), judged, report);
  report.limits = {
      "Cloth does not meet itself or other cloth in any engine of this report.",
      "Contact is between nodes and surfaces; edges and faces of the cloth may cut corners.",
      "The reference's discretization error is that of its time step; what a finer mesh would "
      "change is not "
      "in it.",
      "Sabotages are put into the reference's side of a pair; Bullet's side is not broken on "
      "purpose.",
      "No comparison with measured fabric.",
  };
  if (options.cases.recorded) {
    for (std::string& text : not_judged_texts()) report.limits.push_back(std::move(text));
  }
  return report;
}

}  // namespace weft::validation
