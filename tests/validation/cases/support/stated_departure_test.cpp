#include <weft/validation/cases/support/stated_departure.hpp>

#include <limits>

#include <gtest/gtest.h>

#include <weft/core/error.hpp>

namespace weft::validation {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr MotionDeparture kRows[] = {{"swing", "bullet_weft float32", "energy", 0.5},
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

TEST(MotionDeparture, ChecksWithoutARowAreJudgedAsAlways) {
  Report report;
  CheckResult good = check_of("other", 0.05);
  judge_departing(good, kRows, "why", report);
  EXPECT_EQ(good.verdict, Verdict::kPass);
  CheckResult bad = check_of("other", 0.5);
  judge_departing(bad, kRows, "why", report);
  EXPECT_EQ(bad.verdict, Verdict::kFail);
  EXPECT_TRUE(report.departures.empty());
}

TEST(MotionDeparture, AKnownOneIsShownAndDoesNotFail) {
  Report report;
  CheckResult check = check_of("energy", 0.6);
  judge_departing(check, kRows, "why", report);
  EXPECT_EQ(check.verdict, Verdict::kInfo);
  ASSERT_EQ(report.departures.size(), 1U);
  EXPECT_EQ(report.departures[0].reason, "why");
  EXPECT_NE(report.departures[0].measured.find("0.6"), std::string::npos);
}

TEST(MotionDeparture, OneThatNoLongerOccursIsStaleAndFails) {
  Report report;
  CheckResult check = check_of("energy", 0.05);
  judge_departing(check, kRows, "why", report);
  EXPECT_EQ(check.verdict, Verdict::kFail);
  EXPECT_NE(check.note.find("stale"), std::string::npos);
}

TEST(MotionDeparture, OneThatHasGrownFails) {
  Report report;
  for (const double measured : {5.1, kNaN}) {
    CheckResult check = check_of("energy", measured);
    judge_departing(check, kRows, "why", report);
    EXPECT_EQ(check.verdict, Verdict::kFail) << measured;
  }
  EXPECT_TRUE(report.departures.empty());
}

TEST(MotionDeparture, ABlowUpMayBeStated) {
  Report report;
  CheckResult check = check_of("turn", kNaN);
  judge_departing(check, kRows, "why", report);
  EXPECT_EQ(check.verdict, Verdict::kInfo);
}

TEST(MotionDeparture, NeedsATolerance) {
  Report report;
  CheckResult check = check_of("energy", 0.6);
  check.tolerance.reset();
  EXPECT_THROW(judge_departing(check, kRows, "why", report), InvalidArgument);
}

}  // namespace
}  // namespace weft::validation
