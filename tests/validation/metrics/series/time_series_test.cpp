#include <gtest/gtest.h>

#include <vector>

#include <weft/core/error.hpp>
#include <weft/validation/metrics/series/line_fit.hpp>
#include <weft/validation/metrics/series/time_series.hpp>

#include "tests/validation/metrics/test_shapes.hpp"

namespace weft::validation {
namespace {

const std::vector<double> kTimes{0.0, 1.0, 3.0, 4.0};

TEST(TimeSeries, LargestIsTheFirstOfEquals) {
  const Extreme largest = largest_over_time(kTimes, std::vector<double>{-5, 2, 2, 1});
  EXPECT_EQ(largest.value, 2.0);
  EXPECT_EQ(largest.time, 1.0);
  EXPECT_EQ(largest_over_time(kTimes, std::vector<double>{-5, -4, -3, -6}).value, -3.0);
}

TEST(TimeSeries, MeanWeighsIntervalsNotSamples) {
  // Trapezoids: 0.5 + 2 * 1.5 + 2 = 5.5 over 4 s.
  EXPECT_NEAR(mean_over_time(kTimes, std::vector<double>{0, 1, 2, 2}), 5.5 / 4.0, kRoundoff);
  EXPECT_EQ(mean_over_time(std::vector<double>{7.0}, std::vector<double>{3.0}), 3.0);
}

TEST(TimeSeries, ValueAtInterpolatesAndNeverExtrapolates) {
  const std::vector<double> values{0, 1, 5, 4};
  EXPECT_EQ(value_at(kTimes, values, 0.0), 0.0);
  EXPECT_EQ(value_at(kTimes, values, 4.0), 4.0);
  EXPECT_NEAR(*value_at(kTimes, values, 2.5), 4.0, kRoundoff);
  EXPECT_FALSE(value_at(kTimes, values, -1e-9));
  EXPECT_FALSE(value_at(kTimes, values, 4.0000001));
  EXPECT_FALSE(value_at(kTimes, values, kNaN));
}

TEST(TimeSeries, WhatIsNotFiniteIsNeverSmall) {
  for (const double bad : {kNaN, kInfinity, -kInfinity}) {
    const std::vector<double> values{0, 1, bad, 2};
    EXPECT_TRUE(std::isnan(largest_over_time(kTimes, values).value));
    EXPECT_EQ(largest_over_time(kTimes, values).time, 3.0);
    EXPECT_TRUE(std::isnan(mean_over_time(kTimes, values)));
    EXPECT_TRUE(std::isnan(*value_at(kTimes, values, 2.0)));
    EXPECT_TRUE(std::isnan(*value_at(kTimes, values, 3.0)));
    EXPECT_EQ(value_at(kTimes, values, 1.0), 1.0);
  }
}

TEST(TimeSeries, GrowthRateOfAnExponentialIsExact) {
  std::vector<double> times;
  std::vector<double> values;
  for (int i = 0; i <= 100; ++i) {
    times.push_back(0.05 * i);
    values.push_back(i < 20 ? 1e-12 : 3e-9 * std::exp(2.5 * times.back()));  // after 1 s
  }
  const auto growth = growth_rate(times, values, 1.0, 5.0);
  ASSERT_TRUE(growth);
  EXPECT_NEAR(growth->rate, 2.5, 10 * kRoundoff);
  EXPECT_NEAR(growth->initial, 3e-9, 3e-9 * 100 * kRoundoff);
  EXPECT_NEAR(growth->r_squared, 1.0, kRoundoff);
  EXPECT_EQ(growth->num_samples, 81);
}

TEST(TimeSeries, GrowthIsNoneWhereThereIsNone) {
  EXPECT_FALSE(growth_rate(kTimes, std::vector<double>{1, 0, 2, 3}, 0, 4));
  EXPECT_FALSE(growth_rate(kTimes, std::vector<double>{1, 2, kNaN, 3}, 0, 4));
  EXPECT_FALSE(growth_rate(kTimes, std::vector<double>{1, 2, 4, 8}, 0.5, 1.5));
}

TEST(TimeSeries, RefusesWhatIsNoSeries) {
  const std::vector<double> two{0.0, 1.0};
  EXPECT_THROW((void)mean_over_time(kTimes, two), InvalidArgument);
  EXPECT_THROW((void)mean_over_time({}, {}), InvalidArgument);
  EXPECT_THROW((void)mean_over_time(std::vector<double>{1.0, 1.0}, two), InvalidArgument);
  EXPECT_THROW((void)mean_over_time(std::vector<double>{0.0, kNaN}, two), InvalidArgument);
}

TEST(LineFit, FindsTheLineAndItsScatter) {
  const auto exact = fit_line(std::vector<double>{0, 1, 2}, std::vector<double>{1, 3, 5});
  ASSERT_TRUE(exact);
  EXPECT_NEAR(exact->slope, 2.0, kRoundoff);
  EXPECT_NEAR(exact->intercept, 1.0, kRoundoff);
  EXPECT_NEAR(exact->r_squared, 1.0, kRoundoff);
  // y = 0, 1, 0, 1 over 0..3: slope 1/5, intercept 1/5, r^2 = 1/5.
  const auto zigzag = fit_line(std::vector<double>{0, 1, 2, 3}, std::vector<double>{0, 1, 0, 1});
  EXPECT_NEAR(zigzag->slope, 0.2, kRoundoff);
  EXPECT_NEAR(zigzag->intercept, 0.2, kRoundoff);
  EXPECT_NEAR(zigzag->r_squared, 0.2, kRoundoff);
  EXPECT_FALSE(fit_line(std::vector<double>{1, 1}, std::vector<double>{1, 2}));
  EXPECT_FALSE(fit_line(std::vector<double>{1, 2}, std::vector<double>{1, kNaN}));
  EXPECT_THROW((void)fit_line(std::vector<double>{1}, {}), InvalidArgument);
}

}  // namespace
}  // namespace weft::validation
