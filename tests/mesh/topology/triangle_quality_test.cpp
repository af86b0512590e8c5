#include <weft/mesh/topology/triangle_quality.hpp>

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include <weft/mesh/cloth_grid.hpp>

namespace weft {
namespace {

constexpr double kRoundoff = 1e-12;
constexpr double kDegree = std::numbers::pi / 180;

/// One triangle with a base of this length along x and its tip above a point of it.
TriangleQuality quality_of(double base, double foot, double height) {
  Matrix3X<double> positions(3, 3);
  positions << 0, base, foot, 0, 0, height, 0, 0, 0;
  Triangles triangle(3, 1);
  triangle << 0, 1, 2;
  return triangle_quality(positions, triangle, 3 * kDegree);
}

TEST(TriangleQuality, AnEquilateralTriangleHasItsCircumradiusForAGap) {
  const double height = std::sqrt(3.0) / 2;
  const TriangleQuality quality = quality_of(1, 0.5, height);
  EXPECT_NEAR(quality.smallest_angle, 60 * kDegree, kRoundoff);
  EXPECT_NEAR(quality.largest_gap, 1 / std::sqrt(3.0), kRoundoff);
  EXPECT_NEAR(quality.shortest_edge, 1, kRoundoff);
  EXPECT_EQ(quality.num_sharp, 0);
}

TEST(TriangleQuality, AnObtuseTriangleHasAGapOfHalfItsLongestEdge) {
  const TriangleQuality quality = quality_of(1, 0.5, 0.1);
  EXPECT_NEAR(quality.largest_gap, 0.5, kRoundoff);
  EXPECT_NEAR(quality.smallest_angle, std::atan(0.2), kRoundoff);
}

TEST(TriangleQuality, SharpTrianglesAreCountedAndTheSharpestNamed) {
  EXPECT_EQ(quality_of(1, 0, std::tan(3.1 * kDegree)).num_sharp, 0);
  const TriangleQuality sharp = quality_of(1, 0, std::tan(2.9 * kDegree));
  EXPECT_EQ(sharp.num_sharp, 1);
  EXPECT_EQ(sharp.sharpest, 0);
  EXPECT_NEAR(sharp.smallest_angle, 2.9 * kDegree, 1e-10);
}

TEST(TriangleQuality, ATriangleWithoutAnAreaHasNoAngle) {
  EXPECT_EQ(quality_of(1, 0.5, 0).smallest_angle, 0);
  EXPECT_EQ(quality_of(0, 0, 0).smallest_angle, 0);
  EXPECT_TRUE(std::isfinite(quality_of(0, 0, 0).largest_gap));
}

TEST(TriangleQuality, OfAGridIsThatOfHalfASquare) {
  const ClothMesh mesh = make_cloth_grid({.nodes = {6, 6}, .size = {1.0, 1.0}});
  const TriangleQuality quality = triangle_quality(mesh.rest_positions, mesh.triangles, 0.1);
  EXPECT_NEAR(quality.smallest_angle, 45 * kDegree, kRoundoff);
  EXPECT_NEAR(quality.largest_gap, 0.2 / std::numbers::sqrt2, kRoundoff);
  EXPECT_NEAR(quality.shortest_edge, 0.2, kRoundoff);
  EXPECT_NEAR(quality.longest_edge, 0.2 * std::numbers::sqrt2, kRoundoff);
}

TEST(TriangleQuality, OfNoTriangleIsNothing) {
  const TriangleQuality quality = triangle_quality(Matrix3X<double>(3, 0), Triangles(3, 0), 0.1);
  EXPECT_EQ(quality.sharpest, -1);
  EXPECT_EQ(quality.longest_edge, 0);
}

}  // namespace
}  // namespace weft
