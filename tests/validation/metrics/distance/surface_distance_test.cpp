#include <gtest/gtest.h>

#include <algorithm>

#include <weft/core/error.hpp>
#include <weft/validation/metrics/distance/point_triangle.hpp>
#include <weft/validation/metrics/distance/surface_distance.hpp>
#include <weft/validation/metrics/distance/surface_index.hpp>
#include <weft/validation/metrics/series/percentile.hpp>

#include "tests/validation/metrics/test_shapes.hpp"

namespace weft::validation {
namespace {

Surface surface_of(const ClothMesh& mesh) {
  return {mesh.rest_positions, mesh.triangles};
}

Surface random_surface(std::uint64_t seed, Eigen::Index nodes, Eigen::Index triangles) {
  Sequence sequence(seed);
  Surface surface{sequence.columns(nodes), Triangles(3, triangles)};
  for (int& corner : surface.triangles.reshaped()) {
    corner = static_cast<int>((sequence.next() + 1.0) / 2.0 * static_cast<double>(nodes));
  }
  return surface;
}

/// Finest point of a regular subdivision of the triangle; never below the true distance.
double sampled_distance(const Vector3<double>& point, const Triangle& t, int divisions) {
  double best = kInfinity;
  for (int i = 0; i <= divisions; ++i) {
    for (int j = 0; i + j <= divisions; ++j) {
      const double u = static_cast<double>(i) / divisions;
      const double v = static_cast<double>(j) / divisions;
      best = std::min(best, (point - (t.a + u * (t.b - t.a) + v * (t.c - t.a))).norm());
    }
  }
  return best;
}

TEST(PointTriangle, KnowsFaceEdgesAndCorners) {
  const Triangle t{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}};
  EXPECT_NEAR(point_triangle_distance({0.5, 0.5, 3}, t), 3.0, kRoundoff);
  EXPECT_NEAR(point_triangle_distance({0.5, 0.5, -3}, t), 3.0, kRoundoff);
  EXPECT_NEAR(point_triangle_distance({1, -2, 0}, t), 2.0, kRoundoff);
  EXPECT_NEAR(point_triangle_distance({2, 2, 0}, t), std::sqrt(2.0), kRoundoff);
  EXPECT_NEAR(point_triangle_distance({-3, -4, 0}, t), 5.0, kRoundoff);
  EXPECT_NEAR(point_triangle_distance({5, 0, 4}, t), 5.0, kRoundoff);
  EXPECT_EQ(point_triangle_distance({0, 2, 0}, t), 0.0);
}

TEST(PointTriangle, NeverMissesWhatFineSamplingFinds) {
  constexpr int kDivisions = 200;
  // The nearest sample is at most one sampling step, edge / kDivisions, from the nearest point;
  // edges are below 4.
  constexpr double kSamplingStep = 4.0 / kDivisions;
  Sequence sequence(11);
  for (int trial = 0; trial < 100; ++trial) {
    const Triangle t{sequence.vector(), sequence.vector(), sequence.vector()};
    const Vector3<double> point = 2.0 * sequence.vector();
    const double exact = point_triangle_distance(point, t);
    const double sampled = sampled_distance(point, t, kDivisions);
    EXPECT_LE(exact, sampled + kRoundoff);
    EXPECT_GE(exact, sampled - kSamplingStep);
  }
}

TEST(PointTriangle, DegenerateTrianglesAreSegmentsAndPoints) {
  const Triangle segment{{0, 0, 0}, {2, 0, 0}, {1, 0, 0}};
  EXPECT_NEAR(point_triangle_distance({1.5, 2, 0}, segment), 2.0, kRoundoff);
  EXPECT_NEAR(point_triangle_distance({5, 4, 0}, segment), 5.0, kRoundoff);
  const Triangle point{{1, 1, 1}, {1, 1, 1}, {1, 1, 1}};
  EXPECT_NEAR(point_triangle_distance({1, 3, 1}, point), 2.0, kRoundoff);
  for (const double height : {1e-3, 1e-7, 1e-9, 1e-12}) {
    const Triangle needle{{0, 0, 0}, {1, 0, 0}, {0.5, height, 0}};
    // The error that kFlatnessRatio allows, on a length of 1 m.
    EXPECT_NEAR(point_triangle_distance({0.5, height / 2, 0.1}, needle), 0.1, kFlatnessRatio);
  }
}

TEST(SurfaceIndex, AgreesWithBruteForceOnScatteredTriangles) {
  const Surface surface = random_surface(21, 150, 400);  // some triangles use a node twice
  const SurfaceIndex index(surface.positions, surface.triangles);
  Sequence sequence(22);
  for (int trial = 0; trial < 300; ++trial) {
    const Vector3<double> point = 3.0 * sequence.vector();
    double brute = kInfinity;
    for (Eigen::Index t = 0; t < surface.triangles.cols(); ++t) {
      brute = std::min(
          brute, point_triangle_distance(point, {surface.positions.col(surface.triangles(0, t)),
                                                 surface.positions.col(surface.triangles(1, t)),
                                                 surface.positions.col(surface.triangles(2, t))}));
    }
    EXPECT_EQ(index.distance(point), brute);  // the same function on the same corners: equal bits
  }
}

TEST(SurfaceDistance, OfParallelSquaresIsTheirGapWhateverTheirMeshes) {
  const Surface low = surface_of(flat_cloth(7, 2.0, 0.0));
  const Surface high = surface_of(flat_cloth(4, 2.0, 0.25));
  const SurfaceDistance d = surface_distance(low, high);
  EXPECT_NEAR(d.hausdorff, 0.25, kRoundoff);
  EXPECT_NEAR(d.hausdorff_95, 0.25, kRoundoff);
  EXPECT_NEAR(d.chamfer, 0.25, kRoundoff);
}

TEST(SurfaceDistance, IsSymmetricThoughItsHalvesAreNot) {
  const Surface small = surface_of(flat_cloth(5, 2.0));
  const Surface large = surface_of(flat_cloth(5, 4.0));
  const SurfaceDistance d = surface_distance(small, large);
  EXPECT_LT(d.a_to_b.largest, kRoundoff);  // the small square lies in the large one
  EXPECT_NEAR(d.b_to_a.largest, std::sqrt(2.0), kRoundoff);
  EXPECT_EQ(d.b_to_a.largest_node, 0);
  // There are 25 nodes at spacing 1: 4 corners sqrt 2 away, 12 edge nodes 1 away, 9 on the small square.
  EXPECT_NEAR(d.b_to_a.mean, (4 * std::sqrt(2.0) + 12.0) / 25.0, kRoundoff);
  EXPECT_NEAR(d.chamfer, 0.5 * (4 * std::sqrt(2.0) + 12.0) / 25.0, kRoundoff);
  EXPECT_NEAR(d.b_to_a.percentile_95, std::sqrt(2.0), kRoundoff);
  const SurfaceDistance swapped = surface_distance(large, small);
  EXPECT_EQ(swapped.hausdorff, d.hausdorff);
  EXPECT_EQ(swapped.chamfer, d.chamfer);
}

TEST(SurfaceDistance, SlidingAlongItselfIsSeenByVerticesOnly) {
  const ClothMesh mesh = flat_cloth(9, 2.0);
  Surface slid = surface_of(mesh);
  slid.positions.colwise() += Vector3<double>(0.1, 0, 0);
  const SurfaceDistance d = surface_distance(surface_of(mesh), slid);
  EXPECT_NEAR(d.hausdorff, 0.1, kRoundoff);      // at the rim
  EXPECT_NEAR(d.chamfer, 0.1 / 9.0, kRoundoff);  // one column of nine
}

TEST(SurfaceDistance, NonFiniteInputIsNeverSmall) {
  const Surface good = surface_of(flat_cloth(3, 1.0));
  for (const double bad : {kNaN, kInfinity}) {
    Surface broken = good;
    broken.positions(0, 5) = bad;
    for (const SurfaceDistance& d :
         {surface_distance(good, broken), surface_distance(broken, good)}) {
      EXPECT_TRUE(std::isnan(d.hausdorff));
      EXPECT_TRUE(std::isnan(d.hausdorff_95));
      EXPECT_TRUE(std::isnan(d.chamfer));
    }
    // From the broken surface its broken node is named; towards it no distance is known, from the
    // first node on.
    EXPECT_EQ(surface_distance(broken, good).a_to_b.largest_node, 5);
    EXPECT_EQ(surface_distance(good, broken).a_to_b.largest_node, 0);
    EXPECT_TRUE(std::isnan(surface_distance(good, broken).b_to_a.largest));
  }
}

TEST(SurfaceDistance, RefusesSurfacesThatAreNone) {
  const Surface good = surface_of(flat_cloth(3, 1.0));
  Surface empty = good;
  empty.triangles.resize(3, 0);
  EXPECT_THROW((void)surface_distance(good, empty), InvalidArgument);
  Surface wrong = good;
  wrong.triangles(1, 1) = 9;
  EXPECT_THROW((void)surface_distance(wrong, good), InvalidArgument);
  EXPECT_THROW((void)distances_to_surface(Matrix3X<double>(3, 0), good), InvalidArgument);
}

TEST(Percentile, IsLinearBetweenRanks) {
  const VectorX<double> values{{40.0, 10.0, 30.0, 20.0}};
  EXPECT_EQ(percentile(values, 0), 10.0);
  EXPECT_EQ(percentile(values, 50), 25.0);
  EXPECT_EQ(percentile(values, 100), 40.0);
  EXPECT_NEAR(percentile(values, 95), 38.5, kRoundoff * 40);  // rank 2.85
  EXPECT_TRUE(std::isnan(percentile(VectorX<double>{{1.0, kNaN}}, 0)));
  EXPECT_TRUE(std::isnan(percentile(VectorX<double>(0), 50)));
  EXPECT_THROW((void)percentile(values, 101), InvalidArgument);
  EXPECT_THROW((void)percentile(values, kNaN), InvalidArgument);
}

}  // namespace
}  // namespace weft::validation
