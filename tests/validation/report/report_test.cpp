#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include <weft/validation/report/ratio.hpp>
#include <weft/validation/report/report.hpp>

#include "tests/validation/report/sample_report.hpp"

namespace weft::validation {
namespace {

CheckResult gated(double measured, double allowed, Basis basis = Basis::kModelGap) {
  CheckResult check;
  check.measured = measured;
  check.tolerance = Tolerance{allowed, basis, "test"};
  check.verdict = judge(measured, *check.tolerance);
  return check;
}

TEST(Report, PassesWithPassedAndUngatedRows) {
  Report report;
  report.checks = {gated(1.0, 2.0), CheckResult{}};
  EXPECT_TRUE(report.passed());
}

TEST(Report, FailsWithOneFailedCheck) {
  Report report;
  report.checks = {gated(1.0, 2.0), gated(3.0, 2.0)};
  EXPECT_FALSE(report.passed());
}

TEST(Report, FailsWhenASabotageIsNotNoticed) {
  Report report;
  report.checks = {gated(1.0, 2.0)};
  report.checks[0].sabotages = {{"a", 5.0, true}};
  EXPECT_TRUE(report.passed());
  report.checks[0].sabotages.push_back({"b", 1.5, false});
  EXPECT_FALSE(report.passed());
}

TEST(Report, FailsWhenTheMeasuredValueIsNotANumber) {
  Report report;
  report.checks = {gated(std::numeric_limits<double>::quiet_NaN(), 2.0)};
  EXPECT_FALSE(report.passed());
}

TEST(Report, SamplesCoverBothVerdicts) {
  EXPECT_FALSE(tests::sample_report().passed());
  EXPECT_TRUE(tests::passing_report().passed());
  EXPECT_FALSE(tests::passing_report().checks.empty());
}

TEST(Ratio, IsMeasuredOverAllowed) {
  EXPECT_EQ(ratio(gated(1.0, 4.0)), 0.25);
  EXPECT_FALSE(ratio(CheckResult{}).has_value());
}

TEST(Ratio, OfAZeroBoundIsZeroOrInfinite) {
  EXPECT_EQ(ratio(gated(0.0, 0.0)), 0.0);
  EXPECT_EQ(ratio(gated(1e-300, 0.0)), std::numeric_limits<double>::infinity());
  EXPECT_TRUE(std::isnan(*ratio(gated(std::numeric_limits<double>::quiet_NaN(), 0.0))));
}

TEST(RatioFlag, MarksTightAndLooseBounds) {
  EXPECT_EQ(ratio_flag(gated(0.51, 1.0)), "tight");
  EXPECT_EQ(ratio_flag(gated(0.5, 1.0)), "");
  EXPECT_EQ(ratio_flag(gated(0.01, 1.0)), "");
  EXPECT_EQ(ratio_flag(gated(0.0099, 1.0)), "loose");
}

TEST(RatioFlag, SparesExactFailedAndUngatedRows) {
  EXPECT_EQ(ratio_flag(gated(0.0, 0.0, Basis::kExact)), "");
  EXPECT_EQ(ratio_flag(gated(2.0, 1.0)), "");
  EXPECT_EQ(ratio_flag(CheckResult{}), "");
}

}  // namespace
}  // namespace weft::validation
