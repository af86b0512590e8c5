#include <gtest/gtest.h>

#include <vector>

#include <weft/core/error.hpp>
#include <weft/validation/metrics/settling.hpp>

#include "tests/validation/metrics/test_shapes.hpp"

namespace weft::validation {
namespace {

/// Samples every 0.1 s.
std::vector<double> tenths(std::size_t n) {
  std::vector<double> times;
  for (std::size_t i = 0; i < n; ++i) times.push_back(0.1 * static_cast<double>(i));
  return times;
}

TEST(Settling, StartsWithTheFirstSampleThatStaysBelow) {
  std::vector<double> values(20, 1e-7);
  values[0] = values[1] = values[2] = 1.0;
  const Settling s = settling(tenths(20), values);
  ASSERT_TRUE(s.time);
  EXPECT_EQ(*s.time, tenths(20)[3]);
  EXPECT_TRUE(s.stays_settled);
  EXPECT_EQ(s.residual, 1e-7);
}

TEST(Settling, AShortRestIsNoRest) {
  std::vector<double> values(20, 1e-7);
  values[0] = values[4] = 1.0;  // below from 0.1 to 0.3 s only, then from 0.5 s
  EXPECT_EQ(settling(tenths(20), values).time, tenths(20)[5]);
}

TEST(Settling, TheHoldTimeIsReachedInSpiteOfRoundedTimes) {
  // 0.1 i is not exact: 0.8 - 0.3 is below 0.5 by one rounding.
  std::vector<double> values(9, 0.0);
  values[0] = values[1] = values[2] = 1.0;
  ASSERT_LT(tenths(9)[8] - tenths(9)[3], 0.5 + kEpsilon);
  EXPECT_EQ(settling(tenths(9), values).time, tenths(9)[3]);
}

TEST(Settling, IsNoneWhenTheSeriesEndsTooSoonOrNeverRests) {
  EXPECT_FALSE(settling(tenths(5), std::vector<double>(5, 0.0)).time);
  const Settling moving = settling(tenths(20), std::vector<double>(20, 1e-6));
  EXPECT_FALSE(moving.time);  // the threshold itself is not below the threshold
  EXPECT_FALSE(moving.stays_settled);
  EXPECT_EQ(moving.residual, 1e-6);
}

TEST(Settling, SeesWhenRestIsLeftAgain) {
  std::vector<double> values(20, 0.0);
  values[15] = 2.0;
  const Settling s = settling(tenths(20), values);
  EXPECT_EQ(s.time, 0.0);
  EXPECT_FALSE(s.stays_settled);
  EXPECT_EQ(s.residual, 2.0);
}

TEST(Settling, ThresholdAndHoldAreParameters) {
  const std::vector<double> values(5, 1e-3);
  EXPECT_EQ(settling(tenths(5), values, {.threshold = 1e-2, .hold = 0.2}).time, 0.0);
}

TEST(Settling, WhatIsNotFiniteIsNotAtRest) {
  std::vector<double> values(20, 0.0);
  values[17] = kNaN;
  const Settling s = settling(tenths(20), values);
  EXPECT_EQ(s.time, 0.0);
  EXPECT_FALSE(s.stays_settled);
  EXPECT_TRUE(std::isnan(s.residual));
  EXPECT_FALSE(settling(tenths(20), std::vector<double>(20, kNaN)).time);
}

TEST(Settling, ForceResidualIsTheWorstFreeNodeInWeights) {
  Matrix3X<double> forces = Matrix3X<double>::Zero(3, 3);
  forces(1, 0) = 1e9;  // pinned: what holds it is not a residual
  forces(0, 1) = 0.3;
  forces(2, 2) = -0.4;
  const VectorX<double> masses{{1.0, 0.1, 0.2}};
  EXPECT_NEAR(force_residual(forces, masses, {0}, 10.0), 0.3, kRoundoff);
  EXPECT_EQ(force_residual(forces, masses, {0, 1, 2}, 10.0), 0.0);
  forces(0, 2) = kNaN;
  EXPECT_TRUE(std::isnan(force_residual(forces, masses, {0}, 10.0)));
}

TEST(Settling, RefusesInputThatMakesNoSense) {
  const std::vector<double> three(3, 0.0);
  EXPECT_THROW((void)settling(tenths(4), three), InvalidArgument);
  EXPECT_THROW((void)settling(three, three), InvalidArgument);  // times stand still
  EXPECT_THROW((void)settling({}, {}), InvalidArgument);
  EXPECT_THROW((void)settling(tenths(3), three, {.threshold = 0.0}), InvalidArgument);
  const Matrix3X<double> forces = Matrix3X<double>::Zero(3, 2);
  EXPECT_THROW((void)force_residual(forces, VectorX<double>::Ones(2), {}, 0.0), InvalidArgument);
  EXPECT_THROW((void)force_residual(forces, VectorX<double>::Ones(1), {}, 1.0), InvalidArgument);
  EXPECT_THROW((void)force_residual(forces, VectorX<double>::Zero(2), {}, 1.0), InvalidArgument);
}

}  // namespace
}  // namespace weft::validation
