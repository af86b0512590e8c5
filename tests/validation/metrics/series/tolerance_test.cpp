#include <gtest/gtest.h>

#include <weft/validation/metrics/series/tolerance.hpp>

#include "tests/validation/metrics/test_shapes.hpp"

namespace weft::validation {
namespace {

TEST(Tolerance, AcceptsUpToAndIncludingItsBound) {
  const Tolerance bound{.value = 1e-3, .basis = Basis::kTruncation, .why = "test"};
  EXPECT_EQ(judge(0.0, bound), Verdict::kPass);
  EXPECT_EQ(judge(1e-3, bound), Verdict::kPass);
  EXPECT_EQ(judge(std::nextafter(1e-3, 1.0), bound), Verdict::kFail);
}

TEST(Tolerance, WhatIsNotANumberFailsAgainstEveryBound) {
  const Tolerance endless{.value = kInfinity, .basis = Basis::kModelGap, .why = "test"};
  for (const double measured : {kNaN, kInfinity, -kInfinity}) {
    EXPECT_EQ(judge(measured, endless), Verdict::kFail) << measured;
  }
  EXPECT_EQ(judge(0.0, {.value = kNaN, .basis = Basis::kExact, .why = "test"}), Verdict::kFail);
}

TEST(Tolerance, EveryBasisHasItsOwnName) {
  EXPECT_EQ(to_string(Basis::kExact), "exact");
  EXPECT_EQ(to_string(Basis::kRoundoff), "round-off");
  EXPECT_EQ(to_string(Basis::kTruncation), "truncation");
  EXPECT_EQ(to_string(Basis::kModelGap), "model gap");
  EXPECT_EQ(to_string(Basis::kStatistical), "statistical");
}

}  // namespace
}  // namespace weft::validation
