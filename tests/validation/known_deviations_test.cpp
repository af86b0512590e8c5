#include <weft/validation/deviations/known_deviations.hpp>

#include <limits>
#include <set>

#include <gtest/gtest.h>

#include <weft/validation/cases.hpp>

namespace weft::validation {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

CheckResult check_of(double measured) {
  CheckResult check;
  check.case_id = "chain";
  check.engine = "bullet_weft float32, 1/60 s";
  check.claim = "hangs";
  check.metric = "error";
  check.unit = "1";
  check.measured = measured;
  check.tolerance = Tolerance{0.01, Basis::kTruncation, "second order"};
  check.verdict = judge(measured, *check.tolerance);
  return check;
}

std::vector<KnownDeviation> stating(double measured) {
  return {{"bullet_weft",
           "it forgets",
           {{"chain", "bullet_weft float32, 1/60 s", "hangs", "error", measured}}}};
}

Report judged(double measured, double stated) {
  Report report;
  report.checks = {check_of(measured)};
  apply_deviations(stating(stated), {"chain"}, report);
  return report;
}

TEST(KnownDeviations, AFailureAsStatedIsKnownAndListedWithItsCause) {
  const Report report = judged(0.2, 0.19);
  EXPECT_EQ(report.checks[0].verdict, Verdict::kKnown);
  EXPECT_EQ(report.checks[0].cause, "it forgets");
  ASSERT_EQ(report.deviations.size(), 1U);
  EXPECT_EQ(report.deviations[0].reason, "it forgets");
  EXPECT_TRUE(report.passed());
}

TEST(KnownDeviations, AWorseFailureStillFails) {
  EXPECT_EQ(judged(0.3, 0.19).checks[0].verdict, Verdict::kFail);
  EXPECT_EQ(judged(std::numeric_limits<double>::quiet_NaN(), 0.19).checks[0].verdict,
            Verdict::kFail);
  EXPECT_EQ(judged(std::numeric_limits<double>::quiet_NaN(), kInfinity).checks[0].verdict,
            Verdict::kKnown);
}

TEST(KnownDeviations, OneThatNoLongerOccursIsStaleAndFailsTheReport) {
  const Report report = judged(0.001, 0.19);
  EXPECT_EQ(report.checks[0].verdict, Verdict::kStale);
  EXPECT_FALSE(report.passed());
}

TEST(KnownDeviations, OneWithoutItsCheckIsStaleWhereTheCaseWasJudgedWhole) {
  Report report;
  apply_deviations(stating(0.2), {"chain"}, report);
  ASSERT_EQ(report.checks.size(), 1U);
  EXPECT_EQ(report.checks[0].verdict, Verdict::kStale);
  EXPECT_FALSE(report.passed());
  Report part;
  apply_deviations(stating(0.2), {"another_case"}, part);
  EXPECT_TRUE(part.checks.empty());
}

TEST(KnownDeviations, OtherFailuresStayFailures) {
  Report report;
  report.checks = {check_of(0.2), check_of(0.2)};
  report.checks[1].claim = "swings";
  apply_deviations(stating(0.2), {"chain"}, report);
  EXPECT_EQ(report.checks[1].verdict, Verdict::kFail);
}

TEST(KnownDeviations, TheTableNamesCasesCausesAndSizesOnce) {
  std::set<std::string_view> ids;
  for (const CaseInfo& info : all_cases()) ids.insert(info.id);
  std::set<std::string> rows;
  for (const KnownDeviation& deviation : known_deviations()) {
    EXPECT_FALSE(deviation.cause.empty());
    EXPECT_FALSE(deviation.failures.empty()) << deviation.cause;
    for (const StatedFailure& failure : deviation.failures) {
      EXPECT_TRUE(ids.contains(failure.case_id)) << failure.case_id;
      EXPECT_GT(failure.measured, 0.0) << failure.claim;
      const std::string row = std::string(failure.case_id) + '|' + std::string(failure.engine) +
                              '|' + std::string(failure.claim) + '|' + std::string(failure.metric);
      EXPECT_TRUE(rows.insert(row).second) << row;
    }
  }
}

}  // namespace
}  // namespace weft::validation
