#include <weft/validation/suite.hpp>

#include <algorithm>

#include <weft/custom_forces/core/error.hpp>
#include <weft/validation/cases.hpp>

namespace weft::validation {
namespace {

std::vector<const CaseInfo*> chosen_cases(const std::vector<std::string>& ids) {
  std::vector<const CaseInfo*> chosen;
  for (const std::string& id : ids) {
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
  if (ids.empty()) {
    for (const CaseInfo& info : all_cases()) chosen.push_back(&info);
  }
  return chosen;
}

}  // namespace

Report run_suite(const SuiteOptions& options,
                 const std::function<void(const std::string& what, double fraction)>& progress) {
  const std::vector<const CaseInfo*> cases = chosen_cases(options.case_ids);
  EngineRuns runs(options.weft, options.folder, options.jobs);
  for (const CaseInfo* info : cases) {
    if (info->plan) info->plan(*info, options.cases, runs);
  }
  runs.run_all(
      [&](double fraction, const std::string& label) { progress("run " + label, fraction); });

  Report report;
  report.title = "Weft validation";
  double done = 0;
  for (const CaseInfo* info : cases) {
    progress("judge " + std::string(info->id), done / static_cast<double>(cases.size()));
    info->evaluate(*info, options.cases, runs, report);
    ++done;
  }
  report.limits = {
      "Cloth does not meet itself or other cloth in any engine of this report.",
      "Contact is between nodes and surfaces; edges and faces of the cloth may cut corners.",
      "The reference is compared at Bullet's own time step; its error against a converged solution "
      "is "
      "not part of this report.",
      "Sabotages are put into the reference's side of a pair; Bullet's side is not broken on "
      "purpose.",
      "No comparison with measured fabric.",
  };
  return report;
}

}  // namespace weft::validation
