#pragma once

// Tested by tests/apps/command_line_test.sh, tests/validation/cases/support/parameters_test.cpp.

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <weft/validation/cases/support/case.hpp>

namespace weft::validation {

struct SuiteOptions {
  std::filesystem::path weft;    ///< executable of the weft command, which runs the simulations
  std::filesystem::path folder;  ///< for scenes, recordings and logs of the runs
  std::vector<std::string> case_ids;  ///< which cases; empty: all
  bool quick = false;                 ///< only those of the commit tier
  int jobs = 1;                       ///< simulations at a time
  CaseOptions cases;
};

/// The cases that these options choose, in the order of the report. Throws InvalidArgument for an unknown case and
/// for values (check_values) or a tier that do not fit.
[[nodiscard]] std::vector<const CaseInfo*> chosen_cases(const SuiteOptions& options);

/// Runs the cases and collects the report. progress: what is being done, and the fraction done of
/// that. Throws as chosen_cases().
[[nodiscard]] Report run_suite(
    const SuiteOptions& options,
    const std::function<void(const std::string& what, double fraction)>& progress);

}  // namespace weft::validation
