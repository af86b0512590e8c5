#include <weft/custom_forces/assembly/arc_tangent.hpp>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

namespace weft::forces {
namespace {

/// Largest error in units in the last place of the true angle, over directions of all lengths and slopes.
template <class Number>
double largest_error() {
  std::mt19937 generator(5);
  std::uniform_real_distribution<double> exponent(-12, 12);
  double largest = 0;
  for (int i = 0; i < 1000000; ++i) {
    const auto sign = [&] { return generator() % 2 == 0 ? 1.0 : -1.0; };
    const auto y = static_cast<Number>(sign() * std::exp(exponent(generator)));
    const auto x = static_cast<Number>(sign() * std::exp(exponent(generator)));
    const long double angle = std::atan2(static_cast<long double>(y), static_cast<long double>(x));
    const auto rounded = static_cast<Number>(std::abs(angle));
    const auto unit = static_cast<double>(
        std::nextafter(rounded, std::numeric_limits<Number>::infinity()) - rounded);
    const auto error =
        static_cast<double>(std::abs(static_cast<long double>(arc_tangent(y, x)) - angle));
    largest = std::max(largest, error / unit);
  }
  return largest;
}

TEST(ArcTangent, IsTheAngleToThreeUnitsInTheLastPlace) {
  EXPECT_LE(largest_error<float>(), 3);
  EXPECT_LE(largest_error<double>(), 3);
}

TEST(ArcTangent, KnowsTheAxesAndTheDiagonals) {
  constexpr double kPi = std::numbers::pi;
  EXPECT_EQ(arc_tangent(0.0, 1.0), 0);
  EXPECT_EQ(arc_tangent(0.0, -1.0), kPi);
  EXPECT_EQ(arc_tangent(-0.0, -1.0), kPi);  // a hinge that is folded flat has one angle, not two
  EXPECT_EQ(arc_tangent(1.0, 0.0), kPi / 2);
  EXPECT_EQ(arc_tangent(-1.0, 0.0), -kPi / 2);
  EXPECT_EQ(arc_tangent(2.0, 2.0), kPi / 4);
  EXPECT_EQ(arc_tangent(-2.0, -2.0), -3 * kPi / 4);
  EXPECT_EQ(arc_tangent(0.0, 0.0), 0);
}

TEST(ArcTangent, KeepsTheSmallestAnglesAndNoNumbers) {
  constexpr double kTiny = 1e-300;
  EXPECT_EQ(arc_tangent(kTiny, 1.0), kTiny);
  EXPECT_EQ(arc_tangent(-kTiny, 1.0), -kTiny);
  constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(std::isnan(arc_tangent(kNoNumber, 1.0)));
  EXPECT_TRUE(std::isnan(arc_tangent(1.0, kNoNumber)));
}

TEST(ArcTangent, HasTheDerivativeOfTheAngle) {
  const Tangent<double> angle = arc_tangent(Tangent<double>(3.0, 0.5), Tangent<double>(4.0, -1.0));
  EXPECT_DOUBLE_EQ(angle.value, std::atan2(3.0, 4.0));
  EXPECT_DOUBLE_EQ(angle.rate, (4.0 * 0.5 + 3.0 * 1.0) / 25.0);
}

}  // namespace
}  // namespace weft::forces
