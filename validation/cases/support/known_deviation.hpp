#pragma once

#include <span>
#include <string>
#include <string_view>

#include <weft/validation/report/report.hpp>

namespace weft::validation {

/// A check that an engine is known to fail, with the figure that it had when this was written down.
struct MotionDeviation {
  std::string_view case_id;
  std::string_view engine;  ///< title, "bullet_weft float32"
  std::string_view metric;  ///< of the check
  double measured;          ///< in the check's unit; not a number: the run blew up
};

/// How much larger than stated a deviation may be before it counts as another one. Where rounding decides how far a run has gone
/// astray, its figure is not the same on every machine.
inline constexpr double kDeviationGrowth = 10.0;

/// Gives a check its verdict, from its measured value and its tolerance.
///
///   no row for it                      kPass or kFail, as always
///   a row, beyond the tolerance        kInfo, and the report gets a Deviation with reason
///   a row, within the tolerance        kFail: the row is stale and must go
///   a row, kDeviationGrowth times it   kFail: it has become worse
///
/// Throws InvalidArgument for a check without a tolerance.
void judge_deviating(CheckResult& check, std::span<const MotionDeviation> stated,
                     const std::string& reason, Report& report);

}  // namespace weft::validation
