#include <weft/validation/cases/support/known_deviation.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <weft/core/error.hpp>

namespace weft::validation {

void judge_deviating(CheckResult& check, std::span<const MotionDeviation> stated,
                     const std::string& reason, Report& report) {
  if (!check.tolerance) {
    throw InvalidArgument(fmt::format("deviations: check '{}' of {} has no tolerance, expected one",
                                      check.metric, check.case_id));
  }
  check.verdict = judge(check.measured, *check.tolerance);
  const auto row = std::find_if(stated.begin(), stated.end(), [&](const MotionDeviation& d) {
    return d.case_id == check.case_id && d.engine == check.engine && d.metric == check.metric;
  });
  if (row == stated.end()) return;
  if (check.verdict == Verdict::kPass) {
    check.verdict = Verdict::kFail;
    check.note = fmt::format(
        "stale: a deviation of {:.3g} is stated and no longer occurs; its row "
        "must go",
        row->measured);
    return;
  }
  const bool has_grown =
      std::isfinite(row->measured) && !(check.measured <= kDeviationGrowth * row->measured);
  if (has_grown) {
    check.note = fmt::format("worse than the stated deviation of {:.3g}", row->measured);
    return;
  }
  check.verdict = Verdict::kInfo;
  check.note = fmt::format("a stated deviation, {:.3g} when it was written down", row->measured);
  report.deviations.push_back({check.engine, fmt::format("{}: {}", check.case_id, check.metric),
                               fmt::format("{:.3g} where {:.3g} is allowed [{}]", check.measured,
                                           check.tolerance->value, check.unit),
                               reason});
}

}  // namespace weft::validation
