#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include <weft/validation/report/report.hpp>

namespace weft::validation {
namespace {

using testing::HasSubstr;
using testing::Not;

CheckResult relative_check(Verdict verdict) {
  CheckResult check;
  check.case_id = "hanging_chain";
  check.engine = "bullet_weft float32, 1/60 s";
  check.claim = "a chain hangs";
  check.metric = "relative error of the tip's drop";
  check.unit = "1";
  check.measured = 0.25;
  check.tolerance = Tolerance{0.01, Basis::kTruncation, "second order"};
  check.verdict = verdict;
  check.values = {{"drop of the tip", 0.05, 0.04, "m"}};
  if (verdict == Verdict::kKnown || verdict == Verdict::kStale)
    check.cause = "the solver forgets it";
  return check;
}

Report report_of(Verdict verdict) {
  Report report;
  report.checks = {relative_check(verdict)};
  return report;
}

TEST(Text, ARelativeErrorStandsBesideItsValueAndTheExpectedOne) {
  EXPECT_THAT(to_text(report_of(Verdict::kFail)),
              HasSubstr("drop of the tip 0.05 m, expected 0.04 m"));
  EXPECT_THAT(to_junit(report_of(Verdict::kFail)),
              HasSubstr("drop of the tip 0.05 m, expected 0.04 m"));
  const auto json = nlohmann::json::parse(to_json(report_of(Verdict::kFail)));
  const auto& pair = json["checks"][0]["values"][0];
  EXPECT_EQ(pair["quantity"], "drop of the tip");
  EXPECT_EQ(pair["value"], 0.05);
  EXPECT_EQ(pair["expected"], 0.04);
  EXPECT_EQ(pair["unit"], "m");
}

TEST(Text, AKnownDeviationIsShownAsAFailureAndKeepsNoReportFromPassing) {
  const Report report = report_of(Verdict::kKnown);
  EXPECT_TRUE(report.passed());
  EXPECT_THAT(to_text(report), HasSubstr("FAIL/known"));
  EXPECT_THAT(to_text(report), HasSubstr("1 of the checks fail as known deviations"));
  EXPECT_THAT(to_junit(report),
              HasSubstr("<skipped message=\"known deviation (the solver forgets it)"));
  EXPECT_THAT(to_junit(report), HasSubstr("failures=\"0\" errors=\"0\" skipped=\"1\""));
  const auto json = nlohmann::json::parse(to_json(report));
  EXPECT_EQ(json["checks"][0]["verdict"], "known");
  EXPECT_EQ(json["checks"][0]["cause"], "the solver forgets it");
  EXPECT_EQ(json["summary"]["checks_known"], 1);
  EXPECT_EQ(json["summary"]["checks_failed"], 0);
}

TEST(Text, AStaleDeviationFailsTheReport) {
  const Report report = report_of(Verdict::kStale);
  EXPECT_FALSE(report.passed());
  EXPECT_THAT(to_text(report), HasSubstr("FAIL/stale"));
  EXPECT_THAT(to_junit(report), HasSubstr("<failure type=\"stale\""));
  EXPECT_EQ(nlohmann::json::parse(to_json(report))["summary"]["checks_stale"], 1);
}

TEST(Text, APassingReportSaysNothingOfDeviations) {
  const Report report = report_of(Verdict::kPass);
  EXPECT_TRUE(report.passed());
  EXPECT_THAT(to_text(report), Not(HasSubstr("deviation")));
  EXPECT_THAT(to_text(report), HasSubstr("PASS: 1 checks"));
}

}  // namespace
}  // namespace weft::validation
