#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include <weft/core/error.hpp>
#include <weft/mesh/position_limits.hpp>

namespace weft {
namespace {

/// Some hundred roundings of numbers of size 4 at most [m]: 1.3e-14 was the worst of 20000.
constexpr double kRounding = 1e-13;

/// One node at the origin whose surface looks up.
PositionLimits one_node(double max_distance, double radius, double offset) {
  PositionLimits limits;
  limits.centers = Matrix3X<double>::Zero(3, 1);
  limits.max_distances = VectorX<double>::Constant(1, max_distance);
  limits.normals = Vector3<double>(0, 1, 0);
  limits.backstop_radii = VectorX<double>::Constant(1, radius);
  limits.backstop_offsets = VectorX<double>::Constant(1, offset);
  return limits;
}

TEST(PositionLimits, ANodeWithinThemStaysWhereItIs) {
  const PositionLimits limits = one_node(0.5, 1.0, 0.0);
  const Vector3<double> position(0.2, 0.3, -0.1);
  EXPECT_EQ(limited_position(limits, 0, position), position);
}

TEST(PositionLimits, ANodeTooFarAwayComesBackOnTheStraightLine) {
  const PositionLimits limits = one_node(0.5, 0.0, 0.0);
  const Vector3<double> allowed = limited_position(limits, 0, {3, 4, 0});
  EXPECT_LT((allowed - Vector3<double>(0.3, 0.4, 0)).norm(), kRounding);
}

TEST(PositionLimits, ANodeInTheBackstopComesOutAlongItsRadius) {
  // The ball begins 0.1 behind the node: its middle is at y = -1.1.
  const PositionLimits limits = one_node(9.0, 1.0, 0.1);
  const Vector3<double> allowed = limited_position(limits, 0, {0.3, -0.7, 0});
  EXPECT_LT((allowed - Vector3<double>(0.6, -0.3, 0)).norm(), kRounding);
  const Vector3<double> from_middle = limited_position(limits, 0, {0, -1.1, 0});
  EXPECT_LT((from_middle - Vector3<double>(0, -0.1, 0)).norm(), kRounding);
}

TEST(PositionLimits, WhereBothActTheNodeGoesToTheNearestPlaceOfTheirCircle) {
  // The spheres meet in the circle y = -0.125: |x|^2 = 0.25 and |x - (0, -1, 0)|^2 = 1.
  const PositionLimits limits = one_node(0.5, 1.0, 0.0);
  const Vector3<double> allowed = limited_position(limits, 0, {0.7, -0.9, 0});
  EXPECT_LT((allowed - Vector3<double>(std::sqrt(0.25 - 0.125 * 0.125), -0.125, 0)).norm(),
            kRounding);
}

TEST(PositionLimits, BothHoldAfterwardsWhereverTheNodeWas) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> spread(-2, 2);
  double worst_reach = -1;
  double worst_backstop = -1;
  for (int i = 0; i < 20000; ++i) {
    const double reach = 0.02 + std::abs(spread(random));
    const double radius = 0.02 + std::abs(spread(random));
    const double offset = std::max(0.0, 0.2 * spread(random));
    const PositionLimits limits = one_node(reach, radius, offset);
    const Vector3<double> position(spread(random), spread(random), spread(random));
    const Vector3<double> allowed = limited_position(limits, 0, position);
    worst_reach = std::max(worst_reach, allowed.norm() - reach);
    const Vector3<double> middle(0, -offset - radius, 0);
    worst_backstop = std::max(worst_backstop, radius - (allowed - middle).norm());
  }
  EXPECT_LT(worst_reach, kRounding);
  EXPECT_LT(worst_backstop, kRounding);
}

TEST(PositionLimits, WithoutAMaximumDistanceOnlyTheBackstopActs) {
  const PositionLimits limits = one_node(std::numeric_limits<double>::infinity(), 1.0, 0.0);
  const Vector3<double> far(100, 5, 3);
  EXPECT_EQ(limited_position(limits, 0, far), far);
}

TEST(PositionLimits, RefuseWhatDoesNotFit) {
  EXPECT_NO_THROW(check_position_limits({}, 5));
  EXPECT_THROW(check_position_limits(one_node(0.5, 0, 0), 2), InvalidArgument);
  EXPECT_THROW(check_position_limits(one_node(-0.5, 0, 0), 1), InvalidArgument);
  EXPECT_THROW(check_position_limits(one_node(0.5, -1, 0), 1), InvalidArgument);
  EXPECT_THROW(check_position_limits(one_node(0.5, 1, -1), 1), InvalidArgument);
  PositionLimits long_normal = one_node(0.5, 1, 0);
  long_normal.normals *= 2;
  EXPECT_THROW(check_position_limits(long_normal, 1), InvalidArgument);
}

}  // namespace
}  // namespace weft
