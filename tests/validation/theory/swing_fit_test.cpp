#include <weft/validation/theory/swing_fit.hpp>

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace weft::validation {
namespace {

std::vector<double> swing(double omega, double decay, double interval, int count) {
  std::vector<double> values;
  for (int n = 0; n < count; ++n) {
    const double t = n * interval;
    values.push_back(std::exp(-decay * t) * std::sin(omega * t + 0.3));
  }
  return values;
}

TEST(SwingFit, FindsFrequencyAndDecayHoweverOftenItIsSampled) {
  for (const double interval : {1.0 / 240, 1.0 / 30, 0.2}) {
    const SwingFit fit = fit_swing(swing(11.0, 0.7, interval, 60), interval);
    EXPECT_NEAR(fit.frequency, 11.0, 1e-7) << interval;
    EXPECT_NEAR(fit.decay, 0.7, 1e-7) << interval;
  }
}

TEST(SwingFit, TellsGrowthFromDecay) {
  EXPECT_NEAR(fit_swing(swing(5.0, -0.2, 0.05, 100), 0.05).decay, -0.2, 1e-7);
}

TEST(SwingFit, WhatDoesNotSwingHasNoFrequency) {
  std::vector<double> creep;
  for (int n = 0; n < 50; ++n) creep.push_back(std::exp(-0.1 * n));
  EXPECT_TRUE(std::isnan(fit_swing(creep, 0.1).frequency));
  EXPECT_TRUE(std::isnan(fit_swing(std::vector<double>(50, 0.0), 0.1).frequency));
  EXPECT_TRUE(std::isnan(fit_swing({1, 2, 3}, 0.1).frequency));
}

TEST(PeriodOf, IsTheTimeBetweenUpwardPasses) {
  EXPECT_NEAR(period_of(swing(3.0, 0.0, 0.01, 2000), 0.01), 2 * std::numbers::pi / 3, 1e-4);
  EXPECT_TRUE(std::isnan(period_of(swing(3.0, 0.0, 0.01, 200), 0.01)));
}

}  // namespace
}  // namespace weft::validation
