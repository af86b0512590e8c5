#include <gtest/gtest.h>

#include <vector>

#include <weft/core/error.hpp>
#include <weft/validation/metrics/series/convergence.hpp>

#include "tests/validation/metrics/test_shapes.hpp"

namespace weft::validation {
namespace {

TEST(Convergence, ObservedOrderOfAPowerLawIsItsExponent) {
  const std::vector<double> steps{0.1, 0.05, 0.02, 0.01};
  for (const double order : {1.0, 2.0, 4.0}) {
    std::vector<double> errors;
    for (const double h : steps) errors.push_back(7.0 * std::pow(h, order));
    EXPECT_NEAR(observed_order(steps, errors).value(), order, 10 * kRoundoff);
  }
}

TEST(Convergence, AnOrderThroughZeroOrNaNIsNone) {
  const std::vector<double> steps{0.1, 0.05};
  EXPECT_FALSE(observed_order(steps, std::vector<double>{1e-3, 0.0}));
  EXPECT_FALSE(observed_order(steps, std::vector<double>{1e-3, kNaN}));
  EXPECT_FALSE(observed_order(steps, std::vector<double>{kInfinity, 1e-3}));
}

TEST(Convergence, RichardsonFindsTheLimitOfAPowerLaw) {
  // f = 5 + 3 h^2 at h = 0.1, 0.2, 0.4.
  const RefinementStudy s = study_refinement({5.03, 5.12, 5.48, 2.0});
  // Differences of numbers near 5 carry 5 eps / 0.09.
  constexpr double kDifferenceRoundoff = kRoundoff * 5 / 0.09;
  EXPECT_EQ(s.kind, RefinementKind::kMonotone);
  EXPECT_NEAR(s.order.value(), 2.0, kDifferenceRoundoff);
  EXPECT_NEAR(s.extrapolated.value(), 5.0, kDifferenceRoundoff);
  EXPECT_NEAR(s.uncertainty.value(), 1.25 * 0.03, kDifferenceRoundoff);
  EXPECT_NEAR(s.gci_fine.value(), 1.25 * 0.03 / 5.03, kDifferenceRoundoff);
  EXPECT_NEAR(s.gci_coarse.value(), 1.25 * 0.12 / 5.12, kDifferenceRoundoff);
  EXPECT_NEAR(s.asymptotic_ratio.value(), 5.03 / 5.12, kDifferenceRoundoff);
  EXPECT_EQ(s.lowest, 5.03);
  EXPECT_EQ(s.highest, 5.48);
}

TEST(Convergence, WorksFromBelowAndForOtherRatios) {
  // f = 1 - h at h = 0.1, 0.3, 0.9.
  const RefinementStudy s = study_refinement({0.9, 0.7, 0.1, 3.0});
  EXPECT_NEAR(s.order.value(), 1.0, 10 * kRoundoff);
  EXPECT_NEAR(s.extrapolated.value(), 1.0, 10 * kRoundoff);
}

TEST(Convergence, OscillationReportsARangeAndNoOrder) {
  const RefinementStudy s = study_refinement({1.0, 1.1, 0.9, 2.0});
  EXPECT_EQ(s.kind, RefinementKind::kOscillatory);
  EXPECT_EQ(s.lowest, 0.9);
  EXPECT_EQ(s.highest, 1.1);
  EXPECT_FALSE(s.order);
  EXPECT_FALSE(s.extrapolated);
  EXPECT_FALSE(s.gci_fine);
}

TEST(Convergence, DivergenceAndLostDifferencesReportNoOrder) {
  EXPECT_EQ(study_refinement({3.0, 2.0, 1.5, 2.0}).kind, RefinementKind::kDiverging);
  EXPECT_EQ(study_refinement({3.0, 2.0, 1.0, 2.0}).kind, RefinementKind::kDiverging);
  EXPECT_EQ(study_refinement({2.0, 2.0, 1.0, 2.0}).kind, RefinementKind::kUnresolved);
  EXPECT_EQ(study_refinement({2.0, 2.0, 2.0, 2.0}).kind, RefinementKind::kUnresolved);
  EXPECT_FALSE(study_refinement({2.0, 2.0, 2.0, 2.0}).order);
}

TEST(Convergence, NonFiniteLevelsAreFlagged) {
  for (const double bad : {kNaN, kInfinity}) {
    for (const RefinementLevels& levels :
         {RefinementLevels{bad, 1, 2, 2}, {1, bad, 2, 2}, {1, 2, bad, 2}}) {
      const RefinementStudy s = study_refinement(levels);
      EXPECT_EQ(s.kind, RefinementKind::kNotFinite);
      EXPECT_TRUE(std::isnan(s.lowest));
      EXPECT_TRUE(std::isnan(s.highest));
      EXPECT_FALSE(s.uncertainty);
    }
  }
}

TEST(Convergence, ALimitAtZeroHasAnUncertaintyButNoRelativeOne) {
  const RefinementStudy s = study_refinement({0.0, 1.0, 3.0, 2.0});
  EXPECT_NEAR(s.uncertainty.value(), 1.25, kRoundoff);
  EXPECT_FALSE(s.gci_fine);
}

TEST(Convergence, OrderOfShapeDifferences) {
  EXPECT_NEAR(order_of_differences(0.01, 0.08, 2.0).value(), 3.0, 10 * kRoundoff);
  EXPECT_FALSE(order_of_differences(0.0, 0.08, 2.0));
  EXPECT_FALSE(order_of_differences(0.01, kNaN, 2.0));
}

TEST(Convergence, TwoLevelsNeedTheMethodsOrderAndALargerMargin) {
  EXPECT_NEAR(two_level_uncertainty(5.03, 5.12, 2.0, 2.0), 3.0 * 0.03, 10 * kRoundoff);
  EXPECT_TRUE(std::isnan(two_level_uncertainty(kNaN, 5.12, 2.0, 2.0)));
}

TEST(Convergence, AConfirmedOrderOfAShapeNeedsTheSmallMargin) {
  const NormStudy s = study_norms(0.01, 0.02, 2.0, {1.0, 1.0});
  EXPECT_TRUE(s.is_confirmed);
  EXPECT_NEAR(s.uncertainty, 1.25 * 0.01, kRoundoff);
  const NormStudy low = study_norms(0.01, 0.015, 2.0, {1.0, 1.0});
  EXPECT_NEAR(low.uncertainty, 1.25 * 0.01 / (1.5 - 1), kRoundoff);
  // An order above the method's lowest is not believed beyond that.
  EXPECT_NEAR(study_norms(0.01, 0.0275, 2.0, {1.0, 1.0}).uncertainty, 1.25 * 0.01, kRoundoff);
  EXPECT_NEAR(study_norms(0.01, 0.04, 2.0, {1.0, 2.0}).uncertainty, 1.25 * 0.01, kRoundoff);
  EXPECT_NEAR(study_norms(0.01, 0.04, 2.0, {2.0, 2.0}).uncertainty, 1.25 * 0.01 / 3, kRoundoff);
}

TEST(Convergence, AnUnconfirmedOrderOfAShapeNeedsTheLargeMargin) {
  for (const double coarse : {0.09, 0.011, 0.01, 0.004, 0.0}) {
    const NormStudy s = study_norms(0.01, coarse, 2.0, {1.0, 1.0});
    EXPECT_FALSE(s.is_confirmed) << coarse;
    EXPECT_NEAR(s.uncertainty, 3 * 0.01, kRoundoff) << coarse;
  }
  EXPECT_FALSE(study_norms(0.01, 0.09, 2.0, {1.0, 2.0}).is_confirmed);
  EXPECT_EQ(study_norms(0.0, 0.01, 2.0, {1.0, 1.0}).uncertainty, 0.0);
  EXPECT_FALSE(std::isfinite(study_norms(kNaN, 0.01, 2.0, {1.0, 1.0}).uncertainty));
  EXPECT_FALSE(std::isfinite(study_norms(0.01, kInfinity, 2.0, {1.0, 1.0}).uncertainty));
  EXPECT_THROW((void)study_norms(0.01, 0.02, 2.0, {2.0, 1.0}), InvalidArgument);
}

TEST(Convergence, RefusesInputThatMakesNoSense) {
  const std::vector<double> one{1.0};
  EXPECT_THROW((void)observed_order(one, one), InvalidArgument);
  EXPECT_THROW((void)observed_order(std::vector<double>{1, -1}, std::vector<double>{1, 1}),
               InvalidArgument);
  EXPECT_THROW((void)observed_order(std::vector<double>{1, 1}, std::vector<double>{1, 2}),
               InvalidArgument);
  EXPECT_THROW((void)study_refinement({1, 2, 3, 1.0}), InvalidArgument);
  EXPECT_THROW((void)order_of_differences(1, 2, kNaN), InvalidArgument);
  EXPECT_THROW((void)two_level_uncertainty(1, 2, 2, 0), InvalidArgument);
}

}  // namespace
}  // namespace weft::validation
