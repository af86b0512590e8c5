#include <gtest/gtest.h>

#include <weft/fast_solver/newton/stop_criterion.hpp>

namespace weft::fast {
namespace {

LinearGain gain(double total, double left = 0) {
  return {.total = total, .left = left};
}

// Gains that shrink by the same factor are a geometric series: the rest of it is known.
TEST(StopCriterion, KnowsTheRestOfAGeometricSeries) {
  for (const double factor : {0.01, 0.3, 0.8}) {
    StopCriterion stop;
    double last = 1;
    for (int k = 0; k < 6; ++k, last *= factor) stop.add(gain(last), last, false);
    const double rest = last / (1 - factor);
    EXPECT_TRUE(stop.is_within(1.01 * rest)) << factor;
    EXPECT_FALSE(stop.is_within(0.99 * rest)) << factor;
    EXPECT_NEAR(stop.energy_left(), rest / 2, 1e-9 * rest);
  }
}

TEST(StopCriterion, CountsWhatTheLinearSolveHasLeft) {
  StopCriterion stop;
  stop.add(gain(1, 0.5), 1, false);
  EXPECT_FALSE(stop.is_within(0.5));
  EXPECT_TRUE(stop.is_within(0.62));
}

// Springs that are softer than the linear system takes them to be: each iteration goes a fifth of the way that is left.
TEST(StopCriterion, CountsTheWayThatIsLeftAlongTheLastStep) {
  StopCriterion stop;
  stop.add({.total = 1, .slope_left = 0.8}, 1, false);
  const double way_left = 0.8 / (1 - 0.8);  // over the step
  EXPECT_FALSE(stop.is_within(0.99 * way_left * way_left));
  EXPECT_TRUE(stop.is_within(1.01 * way_left * way_left));
  stop.add({.total = 1, .slope_left = -0.3}, 1, false);
  EXPECT_TRUE(stop.is_within(10));
}

TEST(StopCriterion, AnIterationThatBrokeDownSolvesNothing) {
  StopCriterion stop;
  stop.set_rounding(1);
  stop.add({.total = 1e-9, .left = 0, .is_broken = true}, 0, false);
  EXPECT_FALSE(stop.is_solved(1));
}

// One accelerated iteration may gain nearly nothing with some way to go: the estimate of what is left remembers those before.
TEST(StopCriterion, RemembersSlowIterations) {
  StopCriterion stop;
  for (const double total : {1.0, 0.8, 0.64, 0.001}) stop.add(gain(total), total, false);
  EXPECT_TRUE(stop.is_within(1e-5));
  EXPECT_GT(stop.energy_left(), 1e-3);
}

TEST(StopCriterion, GainsOfRoundingAreASolution) {
  StopCriterion stop;
  stop.set_rounding(1);
  stop.add(gain(3), 0, false);
  EXPECT_FALSE(stop.is_solved(1e-9)) << "it shrinks";
  stop.add(gain(3), 0, false);
  EXPECT_TRUE(stop.is_solved(1e-9));
  stop.add(gain(30), 0, false);
  EXPECT_FALSE(stop.is_solved(1e-9)) << "more than rounding";
}

TEST(StopCriterion, StallsAfterThreeIterationsThatLowerNothing) {
  StopCriterion stop;
  stop.add(gain(1), 1, false);
  for (int k = 0; k < 3; ++k) {
    EXPECT_FALSE(stop.is_stalled());
    stop.add(gain(1), 0.1, false);
  }
  EXPECT_TRUE(stop.is_stalled());
  stop.add(gain(1), 0.2, false);
  EXPECT_FALSE(stop.is_stalled()) << "the energy sinks";
  for (int k = 0; k < 3; ++k) stop.add(gain(1), 0, false);
  stop.add(gain(1), 0, true);
  EXPECT_FALSE(stop.is_stalled()) << "contact states are new";
}

}  // namespace
}  // namespace weft::fast
