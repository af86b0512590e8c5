// How far a step of Newton's method goes on, on parabolas whose lowest point is known.
#include <weft/fast_solver/newton/extrapolation.hpp>

#include <gtest/gtest.h>

namespace weft::fast {
namespace {

/// The fall over the length 1 of a parabola with this slope, lowest at a length.
double fall(double slope, double lowest) {
  return slope - slope / (2 * lowest);
}

TEST(Extrapolation, GoesToWhereTheParabolaIsLowest) {
  for (const double lowest : {1.6, 2.0, 5.0, 9.0}) {
    EXPECT_NEAR(extrapolation_length(3.0, fall(3.0, lowest), 1e-6), lowest, 1e-9);
  }
}

TEST(Extrapolation, StaysWhereTheLinearizationIsRightOrTooSoft) {
  for (const double lowest : {0.6, 1.0, 1.4}) {
    EXPECT_EQ(extrapolation_length(3.0, fall(3.0, lowest), 1e-6), 1) << lowest;
  }
  EXPECT_EQ(extrapolation_length(3.0, -1.0, 1e-6), 1) << "the energy rises";
}

TEST(Extrapolation, GoesTenTimesAsFarAtMost) {
  EXPECT_EQ(extrapolation_length(3.0, fall(3.0, 20.0), 1e-6), 10);
  EXPECT_EQ(extrapolation_length(3.0, 3.0, 1e-6), 10) << "a straight line";
  EXPECT_EQ(extrapolation_length(3.0, 3.5, 1e-6), 10) << "it falls faster and faster";
}

TEST(Extrapolation, DoesNotGoByWhatMayBeRounding) {
  EXPECT_EQ(extrapolation_length(3e-7, 3e-7, 1e-6), 1);
  EXPECT_EQ(extrapolation_length(3.0, 0.0, 0.0), 1);
}

}  // namespace
}  // namespace weft::fast
