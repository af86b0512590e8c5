#include <weft/mesh/topology/winding.hpp>

#include <map>
#include <random>
#include <utility>

#include <gtest/gtest.h>

#include <weft/mesh/cloth_grid.hpp>

namespace weft {
namespace {

/// How often an edge is run along in the same direction twice.
int num_clashes(const Triangles& triangles) {
  std::map<std::pair<int, int>, int> count;
  int clashes = 0;
  for (Eigen::Index t = 0; t < triangles.cols(); ++t) {
    for (int k = 0; k < 3; ++k) {
      if (++count[{triangles(k, t), triangles((k + 1) % 3, t)}] > 1) ++clashes;
    }
  }
  return clashes;
}

TEST(Winding, TrianglesThatAreWoundAtRandomBecomeAlike) {
  ClothGrid grid;
  grid.nodes = {7, 5};
  const Triangles triangles = make_cloth_grid(grid).triangles;
  ASSERT_EQ(num_clashes(triangles), 0);
  Triangles mixed = triangles;
  std::mt19937 random(3);
  for (Eigen::Index t = 1; t < mixed.cols(); ++t) {
    if (random() % 2 == 0) std::swap(mixed(0, t), mixed(1, t));
  }
  ASSERT_GT(num_clashes(mixed), 0);
  const Triangles wound = wound_alike(mixed);
  EXPECT_EQ(num_clashes(wound), 0);
  EXPECT_EQ(wound.col(0), triangles.col(0));
}

TEST(Winding, PiecesKeepTheWindingOfTheirFirstTriangle) {
  Triangles two(3, 4);
  two << 0, 1, 4, 5,  //
      1, 2, 6, 6,     //
      2, 3, 5, 7;
  const Triangles wound = wound_alike(two);
  EXPECT_EQ(num_clashes(wound), 0);
  EXPECT_EQ(wound.col(0), two.col(0));
  EXPECT_EQ(wound.col(2), two.col(2));
}

TEST(Winding, WhatIsWoundAlikeStaysAsItIs) {
  const Triangles triangles = make_cloth_grid({}).triangles;
  EXPECT_EQ(wound_alike(triangles), triangles);
  EXPECT_EQ(wound_alike(Triangles(3, 0)).cols(), 0);
}

}  // namespace
}  // namespace weft
