#include <weft/validation/metrics/distance/self_intersection.hpp>

#include <limits>

#include <gtest/gtest.h>

#include <weft/mesh/cloth_grid.hpp>

namespace weft::validation {
namespace {

/// Two triangles in the plane y = 0 and two more, folded over them at a height.
ClothMesh folded(double height) {
  ClothMesh mesh = make_cloth_grid({.nodes = {9, 5}, .size = {2.0, 1.0}, .total_mass = 1.0});
  for (int i = 0; i < mesh.num_nodes(); ++i) {
    Vector3<double> x = mesh.rest_positions.col(i);
    // The right half turns over to the left, a little askew so that no edge meets another.
    if (x.x() > 0) x = {-0.9 * x.x(), height, x.z() + 0.03};
    mesh.rest_positions.col(i) = x;
  }
  return mesh;
}

TEST(SelfIntersection, FlatAndFoldedClothsHaveNone) {
  const ClothMesh flat = make_cloth_grid({.nodes = {9, 5}, .size = {2.0, 1.0}, .total_mass = 1.0});
  EXPECT_TRUE(self_piercings(flat.rest_positions, flat.triangles).empty());
  const ClothMesh mesh = folded(0.1);
  EXPECT_TRUE(self_piercings(mesh.rest_positions, mesh.triangles).empty());
}

TEST(SelfIntersection, ANodeThroughALayerIsFoundWithItsEdges) {
  ClothMesh mesh = folded(0.1);
  // One node of the upper layer is pushed through the lower one.
  int pushed = -1;
  for (int i = 0; i < mesh.num_nodes(); ++i) {
    const Vector3<double> x = mesh.rest_positions.col(i);
    if (x.y() > 0 && std::abs(x.x() + 0.45) < 0.01 && std::abs(x.z() - 0.03) < 0.01) pushed = i;
  }
  ASSERT_GE(pushed, 0);
  mesh.rest_positions(1, pushed) = -0.1;
  const std::vector<Piercing> found = self_piercings(mesh.rest_positions, mesh.triangles);
  EXPECT_GE(found.size(), 4U);
  int with_the_node = 0;
  for (const Piercing& piercing : found) {
    EXPECT_LT(piercing.from, piercing.to);
    with_the_node += piercing.from == pushed || piercing.to == pushed ? 1 : 0;
  }
  EXPECT_GE(with_the_node, 4);
}

TEST(SelfIntersection, AgreesWithEveryPairTriedAlone) {
  // A crumpled cloth, made by a formula; brute force through the two-surface count of single parts.
  ClothMesh mesh = make_cloth_grid({.nodes = {12, 12}, .size = {1.0, 1.0}, .total_mass = 1.0});
  for (int i = 0; i < mesh.num_nodes(); ++i) {
    mesh.rest_positions.col(i) =
        0.1 * Vector3<double>(std::sin(12.9 * i), std::sin(78.2 * i), std::sin(37.7 * i));
  }
  std::size_t expected = 0;
  Triangles two(3, 2);
  for (Eigen::Index s = 0; s < mesh.triangles.cols(); ++s) {
    for (Eigen::Index t = 0; t < s; ++t) {
      two << mesh.triangles.col(s), mesh.triangles.col(t);
      const auto a = mesh.triangles.col(s).array();
      const auto b = mesh.triangles.col(t).array();
      if ((a == b[0]).any() || (a == b[1]).any() || (a == b[2]).any()) continue;
      expected += self_piercings(mesh.rest_positions, two).size();
    }
  }
  // Each pair of an edge and a triangle comes once for each triangle of the edge: one or two.
  std::size_t weighted = 0;
  for (const Piercing& piercing : self_piercings(mesh.rest_positions, mesh.triangles)) {
    for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
      const auto nodes = mesh.triangles.col(t).array();
      const auto pierced = mesh.triangles.col(piercing.triangle).array();
      const bool has_edge = (nodes == piercing.from).any() && (nodes == piercing.to).any();
      const bool is_apart = !((pierced == nodes[0]).any() || (pierced == nodes[1]).any() ||
                              (pierced == nodes[2]).any());
      weighted += has_edge && is_apart ? 1 : 0;
    }
  }
  EXPECT_GT(expected, 100U);
  EXPECT_EQ(weighted, expected);
}

TEST(SelfIntersection, TwoSurfacesAreCountedBothWays) {
  Matrix3X<double> floor(3, 3);
  floor << -1, 1, 0, 0, 0, 0, -1, -1, 1;
  Matrix3X<double> flag(3, 3);
  flag << 0, 0, 0.5, -0.5, 0.5, 0.5, 0, 0, 0;
  Triangles one(3, 1);
  one << 0, 1, 2;
  EXPECT_EQ(count_piercings(floor, one, flag, one), 2);  // two edges of the flag
  flag.row(1).array() += 0.6;
  EXPECT_EQ(count_piercings(floor, one, flag, one), 0);
  flag(0, 0) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(count_piercings(floor, one, flag, one), 0);
}

}  // namespace
}  // namespace weft::validation
