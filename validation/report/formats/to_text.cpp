// Tested by tests/validation/report/text_test.cpp.

#include <fmt/format.h>

#include <algorithm>

#include <weft/validation/report/quantity_text.hpp>
#include <weft/validation/report/ratio.hpp>
#include <weft/validation/report/report.hpp>

namespace weft::validation {
namespace {

const char* shown_verdict(Verdict verdict) {
  switch (verdict) {
    case Verdict::kPass:
      return "pass";
    case Verdict::kInfo:
      return "info";
    case Verdict::kKnown:
      return "FAIL/known";
    case Verdict::kStale:
      return "FAIL/stale";
    case Verdict::kFail:
      break;
  }
  return "FAIL";
}

std::string row(const CheckResult& check) {
  const bool caught = std::all_of(check.sabotages.begin(), check.sabotages.end(),
                                  [](const SabotageResult& sabotage) { return sabotage.detected; });
  const std::string metric =
      check.unit == "1" ? check.metric : fmt::format("{} [{}]", check.metric, check.unit);
  const std::optional<double> part = ratio(check);
  return fmt::format(
      "{:<20} {:<25} {:<52} {:>11.3g} {:>11} {:>9}  {}{}\n", check.case_id, check.engine, metric,
      check.measured,
      check.tolerance ? fmt::format("{:.3g}", check.tolerance->value) : std::string("-"),
      part ? fmt::format("{:.2g}", *part) : std::string("-"), shown_verdict(check.verdict),
      caught ? "" : " (a sabotage went unnoticed)");
}

std::string closing(const Report& report) {
  std::size_t num_gated = 0;
  std::size_t num_sabotages = 0;
  std::size_t num_known = 0;
  std::size_t num_stale = 0;
  for (const CheckResult& check : report.checks) {
    if (check.verdict != Verdict::kInfo) ++num_gated;
    if (check.verdict == Verdict::kKnown) ++num_known;
    if (check.verdict == Verdict::kStale) ++num_stale;
    num_sabotages += check.sabotages.size();
  }
  std::string text = fmt::format("\n{}: {} checks, {} more measured without a bound, {} sabotages",
                                 report.passed() ? "PASS" : "FAIL", num_gated,
                                 report.checks.size() - num_gated, num_sabotages);
  if (num_known > 0) text += fmt::format("; {} of the checks fail as known deviations", num_known);
  if (num_stale > 0) text += fmt::format("; {} stated deviations are stale", num_stale);
  return text + "\n";
}

}  // namespace

std::string to_text(const Report& report) {
  std::string text = fmt::format("{:<20} {:<25} {:<52} {:>11} {:>11} {:>9}  {}\n", "case", "engine",
                                 "metric", "measured", "allowed", "ratio", "verdict");
  for (const CheckResult& check : report.checks) {
    text += row(check);
    for (const ComparedValue& pair : check.values)
      text += fmt::format("{:<20} {}\n", "", to_text(pair));
    if (check.verdict == Verdict::kStale) text += fmt::format("{:<20} {}\n", "", check.note);
  }
  return text + closing(report);
}

}  // namespace weft::validation
