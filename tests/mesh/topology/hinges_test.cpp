// Edges and hinges of triangles, against a plain search through all pairs of sides.
#include <algorithm>
#include <array>
#include <numeric>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <weft/core/error.hpp>
#include <weft/mesh/icosphere.hpp>
#include <weft/mesh/topology/hinges.hpp>

namespace weft {
namespace {

/// A closed surface whose triangles, corners and nodes are numbered at random, with one triangle left out.
Triangles shuffled_surface() {
  Triangles triangles = make_icosphere({.frequency = 4}).triangles;
  std::mt19937 random(5);
  std::vector<int> number(static_cast<std::size_t>(triangles.maxCoeff()) + 1);
  std::iota(number.begin(), number.end(), 0);
  std::shuffle(number.begin(), number.end(), random);
  std::vector<int> order(static_cast<std::size_t>(triangles.cols()) - 1);
  std::iota(order.begin(), order.end(), 0);
  std::shuffle(order.begin(), order.end(), random);
  Triangles result(3, std::ssize(order));
  for (Eigen::Index t = 0; t < result.cols(); ++t) {
    const auto turn = static_cast<Eigen::Index>(random() % 3);
    for (Eigen::Index corner = 0; corner < 3; ++corner) {
      const int node = triangles((corner + turn) % 3, order[static_cast<std::size_t>(t)]);
      result(corner, t) = number[static_cast<std::size_t>(node)];
    }
  }
  return result;
}

struct Side {
  int from;
  int to;
  int opposite;
};

std::vector<Side> sides_of(const Triangles& triangles) {
  std::vector<Side> sides;
  for (Eigen::Index t = 0; t < triangles.cols(); ++t) {
    for (int corner = 0; corner < 3; ++corner) {
      sides.push_back(
          {triangles(corner, t), triangles((corner + 1) % 3, t), triangles((corner + 2) % 3, t)});
    }
  }
  return sides;
}

TEST(Hinges, AreThoseOfAllPairsOfSidesInTheOrderOfTheirNaming) {
  const Triangles triangles = shuffled_surface();
  const std::vector<Side> sides = sides_of(triangles);
  std::vector<std::array<int, 4>> expected;
  std::vector<std::array<int, 2>> expected_edges;
  for (std::size_t a = 0; a < sides.size(); ++a) {
    const auto is_same = [&](const Side& other) {
      return std::minmax({other.from, other.to}) == std::minmax({sides[a].from, sides[a].to});
    };
    if (std::any_of(sides.begin(), sides.begin() + static_cast<std::ptrdiff_t>(a), is_same)) {
      continue;
    }
    expected_edges.push_back(
        {std::min(sides[a].from, sides[a].to), std::max(sides[a].from, sides[a].to)});
    for (std::size_t b = a + 1; b < sides.size(); ++b) {
      if (!is_same(sides[b])) continue;
      expected.push_back({sides[a].from, sides[b].from, sides[a].opposite, sides[b].opposite});
    }
  }
  const Hinges hinges = hinges_of_triangles(triangles);
  ASSERT_EQ(hinges.cols(), std::ssize(expected));
  for (Eigen::Index h = 0; h < hinges.cols(); ++h) {
    for (int k = 0; k < 4; ++k) {
      ASSERT_EQ(hinges(k, h), expected[static_cast<std::size_t>(h)][static_cast<std::size_t>(k)]);
    }
  }
  const Edges edges = edges_of_triangles(triangles);
  ASSERT_EQ(edges.cols(), std::ssize(expected_edges));
  EXPECT_EQ(edges.cols(), hinges.cols() + 3);  // one triangle is missing
  for (Eigen::Index e = 0; e < edges.cols(); ++e) {
    const auto& edge = expected_edges[static_cast<std::size_t>(e)];
    ASSERT_EQ(edges(0, e), edge[0]);
    ASSERT_EQ(edges(1, e), edge[1]);
  }
  EXPECT_FALSE(is_closed_surface(triangles));
}

TEST(Hinges, OfNoTrianglesAreNone) {
  EXPECT_EQ(hinges_of_triangles(Triangles(3, 0)).cols(), 0);
  EXPECT_EQ(edges_of_triangles(Triangles(3, 0)).cols(), 0);
  EXPECT_FALSE(is_closed_surface(Triangles(3, 0)));
}

TEST(Hinges, RefuseTrianglesThatMakeNoSurface) {
  Triangles book(3, 3);
  book << 0, 1, 0,  //
      1, 0, 1,      //
      2, 3, 4;
  EXPECT_THROW((void)hinges_of_triangles(book), InvalidArgument);
  Triangles turned(3, 2);
  turned << 0, 0,  //
      1, 1,        //
      2, 3;
  EXPECT_THROW((void)hinges_of_triangles(turned), InvalidArgument);
  Triangles unknown(3, 1);
  unknown << 0, -1, 2;
  EXPECT_THROW((void)edges_of_triangles(unknown), InvalidArgument);
}

}  // namespace
}  // namespace weft
