#include <weft/validation/deviations/known_deviations.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <weft/validation/report/quantity_text.hpp>

namespace weft::validation {
namespace {

bool is_check(const StatedFailure& failure, const CheckResult& check) {
  return failure.case_id == check.case_id && failure.engine == check.engine &&
         failure.claim == check.claim && failure.metric == check.metric;
}

bool is_as_stated(const StatedFailure& failure, const CheckResult& check) {
  if (!std::isfinite(failure.measured)) return true;
  return std::isfinite(check.measured) && check.measured <= kStatedGrowth * failure.measured;
}

std::string size_of(const CheckResult& check) {
  std::string text = fmt::format("{}: {}", check.metric, quantity_text(check.measured, check.unit));
  if (check.tolerance) {
    text += fmt::format(", allowed {}", quantity_text(check.tolerance->value, check.unit));
  }
  for (const ComparedValue& pair : check.values) text += "; " + to_text(pair);
  return text;
}

void apply(const KnownDeviation& deviation, const StatedFailure& failure, CheckResult& check,
           Report& report) {
  check.cause = deviation.cause;
  if (check.verdict == Verdict::kPass) {
    check.verdict = Verdict::kStale;
    check.note = "holds, and is stated to fail: take its row out of deviation_table.cpp";
  } else if (check.verdict == Verdict::kFail && is_as_stated(failure, check)) {
    check.verdict = Verdict::kKnown;
    report.deviations.push_back({check.engine, fmt::format("{}: {}", check.case_id, check.claim),
                                 size_of(check), std::string(deviation.cause)});
  } else if (check.verdict == Verdict::kFail) {
    check.note = fmt::format("stated to fail by {:.3g}, which it exceeds by more than {} times; {}",
                             failure.measured, kStatedGrowth, check.note);
  }
}

CheckResult missing(const KnownDeviation& deviation, const StatedFailure& failure) {
  CheckResult check;
  check.case_id = failure.case_id;
  check.engine = failure.engine;
  check.claim = failure.claim;
  check.metric = failure.metric;
  check.unit = "1";
  check.measured = failure.measured;
  check.verdict = Verdict::kStale;
  check.cause = deviation.cause;
  check.note = "is stated to fail, and there is no such check: mend its row in deviation_table.cpp";
  return check;
}

}  // namespace

void apply_deviations(std::span<const KnownDeviation> stated,
                      const std::vector<std::string_view>& whole_cases, Report& report) {
  for (const KnownDeviation& deviation : stated) {
    for (const StatedFailure& failure : deviation.failures) {
      const auto found =
          std::find_if(report.checks.begin(), report.checks.end(),
                       [&](const CheckResult& check) { return is_check(failure, check); });
      if (found != report.checks.end()) {
        apply(deviation, failure, *found, report);
      } else if (std::find(whole_cases.begin(), whole_cases.end(), failure.case_id) !=
                 whole_cases.end()) {
        report.checks.push_back(missing(deviation, failure));
      }
    }
  }
}

}  // namespace weft::validation
