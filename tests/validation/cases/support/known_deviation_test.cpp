#include <weft/validation/cases/support/known_deviation.hpp>

#include <limits>

#include <gtest/gtest.h>

#include <weft/core/error.hpp>

namespace weft::validation {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr MotionDeviation kRows[] = {{"swing", "bullet_weft float32", "energy", 0.5},
                                     {"swing", "bullet_weft float32", "turn", kNaN}};

CheckResult check_of(const std::string& metric, double measured) {
  CheckResult check;
  check.case_id = "swing";
  check.engine = "bullet_weft float32";
  check.metric = metric;
  check.measured = measured;
  check.tolerance = Tolerance{0.1, Basis::kModelGap, "a test"};
  return check;
}

TEST(MotionDeviation, ChecksWithoutARowAreJudgedAsAlways) {
  Report report;
  CheckResult good = check_of("other", 0.05);
  judge_deviating(good, kRows, "why", report);
  EXPECT_EQ(good.verdict, Verdict::kPass);
  CheckResult bad = check_of("other", 0.5);
  judge_deviating(bad, kRows, "why", report);
  EXPECT_EQ(bad.verdict, Verdict::kFail);
  EXPECT_TRUE(report.deviations.empty());
}

TEST(MotionDeviation, AKnownOneIsShownAndDoesNotFail) {
  Report report;
  CheckResult check = check_of("energy", 0.6);
  judge_deviating(check, kRows, "why", report);
  EXPECT_EQ(check.verdict, Verdict::kInfo);
  ASSERT_EQ(report.deviations.size(), 1U);
  EXPECT_EQ(report.deviations[0].reason, "why");
  EXPECT_NE(report.deviations[0].measured.find("0.6"), std::string::npos);
}

TEST(MotionDeviation, OneThatNoLongerOccursIsStaleAndFails) {
  Report report;
  CheckResult check = check_of("energy", 0.05);
  judge_deviating(check, kRows, "why", report);
  EXPECT_EQ(check.verdict, Verdict::kFail);
  EXPECT_NE(check.note.find("stale"), std::string::npos);
}

TEST(MotionDeviation, OneThatHasGrownFails) {
  Report report;
  for (const double measured : {5.1, kNaN}) {
    CheckResult check = check_of("energy", measured);
    judge_deviating(check, kRows, "why", report);
    EXPECT_EQ(check.verdict, Verdict::kFail) << measured;
  }
  EXPECT_TRUE(report.deviations.empty());
}

TEST(MotionDeviation, ABlowUpMayBeStated) {
  Report report;
  CheckResult check = check_of("turn", kNaN);
  judge_deviating(check, kRows, "why", report);
  EXPECT_EQ(check.verdict, Verdict::kInfo);
}

TEST(MotionDeviation, NeedsATolerance) {
  Report report;
  CheckResult check = check_of("energy", 0.6);
  check.tolerance.reset();
  EXPECT_THROW(judge_deviating(check, kRows, "why", report), InvalidArgument);
}

}  // namespace
}  // namespace weft::validation
