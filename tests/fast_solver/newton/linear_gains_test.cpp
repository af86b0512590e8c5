#include <gtest/gtest.h>

#include <cmath>

#include <weft/fast_solver/newton/linear_gains.hpp>

namespace weft::fast {
namespace {

/// The number of iterations after which a solve ends that gains share^k in iteration k.
int iterations_of(double share, const LinearAccuracy& accuracy) {
  LinearGains gains;
  for (int k = 0; k < 1000; ++k) {
    gains.add(std::pow(share, k));
    if (gains.are_enough(accuracy)) return k + 1;
  }
  return 1000;
}

TEST(LinearGains, EndWhereAFewIterationsGainLessThanTheForcingAsksFor) {
  // The last four of n iterations gain 0.8^(n - 4) (1 - 0.8^4) of 1 - 0.8^n: 0.106 for n = 12, and 0.084 for n = 13.
  EXPECT_EQ(iterations_of(0.8, {.forcing = 0.1}), 13);
  EXPECT_GT(iterations_of(0.8, {.forcing = 0.01}), iterations_of(0.8, {.forcing = 0.1}));
}

TEST(LinearGains, SeeAPlateauIfTheyLookBackFarEnough) {
  // A large gain, a plateau of eight small ones, and again a large one, as a stiff system has them.
  const auto gain = [](int k) { return k == 0 || k == 9 ? 1.0 : k < 9 ? 0.02 : 1e-6; };
  const auto end = [&](const LinearAccuracy& accuracy) {
    LinearGains gains;
    int k = 0;
    do gains.add(gain(k));
    while (!gains.are_enough(accuracy) && ++k < 100);
    return k;
  };
  EXPECT_LT(end({.forcing = 0.1}), 9);
  EXPECT_GT(end({.forcing = 0.1, .delay = 1}), 9);
}

TEST(LinearGains, EndWhereLittleIsLeftToGain) {
  LinearGains gains;
  gains.add(1);
  EXPECT_FALSE(gains.are_enough({.least_gain = 2}));
  gains.add(0.5);
  EXPECT_TRUE(gains.are_enough({.least_gain = 2}));
  EXPECT_FALSE(gains.are_enough({.least_gain = 1}));
}

TEST(LinearGains, SumIsThatOfAllAndOfTheLastOnes) {
  LinearGains gains;
  for (int k = 1; k <= 10; ++k) gains.add(k);
  EXPECT_EQ(gains.sum({}).total, 55);
  EXPECT_EQ(gains.sum({}).left, 7 + 8 + 9 + 10);
  EXPECT_EQ(gains.sum({.delay = 0.5}).left, 6 + 7 + 8 + 9 + 10);
  gains.clear();
  EXPECT_EQ(gains.sum({}).total, 0);
}

// Solves that end because little is left to gain have not seen how much: they may only claim what they ended by.
TEST(LinearGains, WhatIsLeftIsNoLessThanWhatNobodyLookedFor) {
  LinearGains gains;
  gains.add(1e-6);
  gains.add(1e-9);
  EXPECT_EQ(gains.sum({.least_gain = 1e-3}).left, 1e-3);
  EXPECT_EQ(gains.sum({.least_gain = 1e-9}).left, 1e-6 + 1e-9);
  gains.clear();
  EXPECT_EQ(gains.sum({.least_gain = 1e-3}).left, 0);
}

}  // namespace
}  // namespace weft::fast
