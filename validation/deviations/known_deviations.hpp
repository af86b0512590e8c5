#pragma once

// Tested by tests/validation/known_deviations_test.cpp.

#include <span>
#include <string_view>
#include <vector>

#include <weft/validation/report/report.hpp>

namespace weft::validation {

/// A check that is known to fail.
struct StatedFailure {
  std::string_view case_id;
  std::string_view engine;  ///< as the check has it, with precision and step
  std::string_view claim;   ///< of the check
  std::string_view metric;  ///< of the check
  double measured =
      0.0;  ///< when it was stated, in the check's unit; infinity: no number, as of a run that blew up
};

/// Failures that have one cause.
struct KnownDeviation {
  std::string_view engine;  ///< the program: "bullet_weft"
  std::string_view cause;   ///< one sentence, what is wrong and where
  std::vector<StatedFailure> failures;
};

/// A check that fails by more than so many times what was stated is another failure.
inline constexpr double kStatedGrowth = 1.5;

/// The table (deviation_table.cpp). A row goes when its check passes, not before.
[[nodiscard]] std::span<const KnownDeviation> known_deviations();

/// Marks the checks of a report that fail as stated (kKnown) and lists them among its deviations; those that are stated and pass
/// become kStale, and so does a row for every stated check of the cases that were judged whole, if there is no such check.
/// One that fails by more than kStatedGrowth times what was stated still fails (kFail).
void apply_deviations(std::span<const KnownDeviation> stated,
                      const std::vector<std::string_view>& whole_cases, Report& report);

}  // namespace weft::validation
