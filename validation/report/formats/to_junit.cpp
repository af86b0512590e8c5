// Tested by tests/validation/report/junit_test.cpp.

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include <weft/validation/report/formats/xml_text.hpp>
#include <weft/validation/report/quantity_text.hpp>
#include <weft/validation/report/ratio.hpp>
#include <weft/validation/report/report.hpp>

namespace weft::validation {
namespace {

struct Counts {
  int tests = 0;
  int failures = 0;
  int skipped = 0;
};

Counts& operator+=(Counts& sum, const Counts& more) {
  sum.tests += more.tests;
  sum.failures += more.failures;
  sum.skipped += more.skipped;
  return sum;
}

Counts count(const CheckResult& check) {
  const bool fails = check.verdict == Verdict::kFail || check.verdict == Verdict::kStale;
  const bool is_skipped = check.verdict == Verdict::kInfo || check.verdict == Verdict::kKnown;
  Counts counts{1, fails ? 1 : 0, is_skipped ? 1 : 0};
  for (const SabotageResult& sabotage : check.sabotages) {
    counts += {1, sabotage.detected ? 0 : 1, 0};
  }
  return counts;
}

std::string attributes(const Counts& counts) {
  return fmt::format("tests=\"{}\" failures=\"{}\" errors=\"0\" skipped=\"{}\"", counts.tests,
                     counts.failures, counts.skipped);
}

// "measured 2 m, allowed 1 m (ratio 2), basis truncation: C h^2"
std::string comparison(const CheckResult& check, double measured) {
  const std::string what = "measured " + quantity_text(measured, check.unit);
  if (!check.tolerance) return what + ", not gated";
  CheckResult as_measured = check;
  as_measured.measured = measured;
  return fmt::format("{}, allowed {} (ratio {:.4g}), basis {}: {}", what,
                     quantity_text(check.tolerance->value, check.unit), *ratio(as_measured),
                     to_string(check.tolerance->basis), check.tolerance->why);
}

std::string details(const CheckResult& check) {
  std::string text;
  for (const auto& [label, value] :
       {std::pair<const char*, const std::string&>{"compared with", check.formula},
        {"source", check.source},
        {"note", check.note}}) {
    if (!value.empty()) text += fmt::format("{}: {}\n", label, value);
  }
  return text;
}

std::string open_test(const CheckResult& check, const std::string& name) {
  return fmt::format("    <testcase classname=\"{}\" name=\"{}\">\n",
                     xml_text(check.case_id + "." + check.engine), xml_text(name));
}

std::string check_xml(const CheckResult& check) {
  const std::string name = fmt::format("{} [{}]", check.claim, check.metric);
  std::string text = comparison(check, check.measured);
  for (const ComparedValue& pair : check.values) text += "; " + to_text(pair);
  if (check.verdict == Verdict::kKnown) text = "known deviation (" + check.cause + "): " + text;
  if (check.verdict == Verdict::kStale) text = "stale deviation (" + check.cause + "): " + text;
  const std::string result = xml_text(text);
  std::string xml = open_test(check, name);
  if (check.verdict == Verdict::kFail || check.verdict == Verdict::kStale) {
    xml += fmt::format("      <failure type=\"{}\" message=\"{}\">{}</failure>\n",
                       check.verdict == Verdict::kFail ? "bound" : "stale", result,
                       xml_text(details(check)));
  } else if (check.verdict != Verdict::kPass) {
    xml += fmt::format("      <skipped message=\"{}\"/>\n", result);
  } else {
    xml += fmt::format("      <system-out>{}</system-out>\n", result);
  }
  return xml + "    </testcase>\n";
}

std::string sabotage_xml(const CheckResult& check, const SabotageResult& sabotage) {
  const std::string name = fmt::format("sabotage noticed: {} [{}]", sabotage.name, check.metric);
  const std::string result = xml_text(comparison(check, sabotage.measured));
  std::string xml = open_test(check, name);
  if (sabotage.detected) {
    xml += fmt::format("      <system-out>{}</system-out>\n", result);
  } else {
    xml +=
        fmt::format("      <failure type=\"sabotage\" message=\"not noticed: {}\">{}</failure>\n",
                    result, xml_text(details(check)));
  }
  return xml + "    </testcase>\n";
}

// One suite per case, in the order of first appearance.
std::vector<std::string> case_ids(const Report& report) {
  std::vector<std::string> ids;
  for (const CheckResult& check : report.checks) {
    if (std::find(ids.begin(), ids.end(), check.case_id) == ids.end()) ids.push_back(check.case_id);
  }
  return ids;
}

}  // namespace

std::string to_junit(const Report& report) {
  Counts total;
  std::string suites;
  for (const std::string& id : case_ids(report)) {
    Counts counts;
    std::string tests;
    for (const CheckResult& check : report.checks) {
      if (check.case_id != id) continue;
      counts += count(check);
      tests += check_xml(check);
      for (const SabotageResult& sabotage : check.sabotages) tests += sabotage_xml(check, sabotage);
    }
    suites += fmt::format("  <testsuite name=\"{}\" {}>\n{}  </testsuite>\n", xml_text(id),
                          attributes(counts), tests);
    total += counts;
  }
  return fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites name=\"{}\" {}>\n{}</testsuites>\n",
      xml_text(report.title), attributes(total), suites);
}

}  // namespace weft::validation
