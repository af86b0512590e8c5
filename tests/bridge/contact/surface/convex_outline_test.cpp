// Convex polygons in a plane.
#include <weft/bridge/contact/surface/convex_outline.hpp>

#include <random>

#include <gtest/gtest.h>

namespace weft::bridge {
namespace {

TEST(ConvexOutline, OfASquareWithPointsInsideAndOnItsSides) {
  const Polygon hull = convex_hull({{0, 0}, {2, 0}, {1, 0}, {2, 2}, {0, 2}, {1, 1}, {0, 1}});
  EXPECT_EQ(hull.size(), 4U);
  EXPECT_DOUBLE_EQ(area(hull), 4);
}

TEST(ConvexOutline, OfPointsOnALineHasNoArea) {
  EXPECT_EQ(area(convex_hull({{0, 0}, {1, 1}, {2, 2}})), 0);
  EXPECT_EQ(area(convex_hull({{0, 0}})), 0);
}

TEST(ConvexOutline, HasNoPointOutside) {
  std::mt19937 random(1);
  std::normal_distribution<double> number;
  std::vector<PlanePoint> points(200);
  for (PlanePoint& point : points) point = {number(random), number(random)};
  const Polygon hull = convex_hull(points);
  for (std::size_t i = 0; i < hull.size(); ++i) {
    for (const PlanePoint& point : points)
      EXPECT_GE(turn(hull[i], hull[(i + 1) % hull.size()], point), -1e-12);
  }
}

TEST(ConvexOutline, TheAreasOfItsPartsAddUp) {
  const Polygon triangle{{0.1, 0.2}, {3.3, 0.7}, {1.2, 2.9}};
  double sum = 0;
  for (int x = 0; x < 4; ++x) {
    for (int y = 0; y < 3; ++y)
      sum += area(clipped(triangle, {PlanePoint(x, y), PlanePoint(x + 1, y + 1)}));
  }
  EXPECT_NEAR(sum, area(triangle), 1e-12);
  EXPECT_EQ(area(clipped(triangle, {PlanePoint(5, 5), PlanePoint(6, 6)})), 0);
  EXPECT_NEAR(area(clipped(triangle, {PlanePoint(0, 0), PlanePoint(9, 9)})), area(triangle), 1e-12);
}

}  // namespace
}  // namespace weft::bridge
