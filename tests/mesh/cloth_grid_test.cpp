#include <weft/mesh/cloth_grid.hpp>

#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <Eigen/Geometry>
#include <weft/core/error.hpp>

namespace weft {
namespace {

using testing::HasSubstr;

/// n eps scale for sums over the grids used here: at most 2500 terms of size 1.
constexpr double kSumRoundoff = 2500 * std::numeric_limits<double>::epsilon();

ClothGrid classic(GridStencil stencil) {
  ClothGrid grid;
  grid.nodes = {50, 50};
  grid.stencil = stencil;
  return grid;
}

std::vector<int> neighbors(const ClothMesh& mesh) {
  std::vector<int> count(static_cast<std::size_t>(mesh.num_nodes()), 0);
  for (const EdgeSet& set : mesh.edge_sets) {
    for (const int node : set.edges.reshaped()) ++count[static_cast<std::size_t>(node)];
  }
  return count;
}

std::string error_of(const ClothGrid& grid) {
  try {
    (void)make_cloth_grid(grid);
  } catch (const InvalidArgument& error) {
    return error.what();
  }
  return "no error";
}

TEST(ClothGrid, TheClassicClothHas2500NodesAnd28518Springs) {
  const ClothMesh mesh = make_cloth_grid(classic(GridStencil::k24Neighbour));
  EXPECT_EQ(mesh.num_nodes(), 2500);
  EXPECT_EQ(mesh.num_edges(), 28518);
  EXPECT_EQ(mesh.triangles.cols(), 2 * 49 * 49);
}

TEST(ClothGrid, SmallerStencilsHaveFewerSprings) {
  EXPECT_EQ(make_cloth_grid(classic(GridStencil::k12Neighbour)).num_edges(), 14502);
  const ClothMesh eight = make_cloth_grid(classic(GridStencil::k8Neighbour));
  EXPECT_EQ(eight.num_edges(), 2 * 50 * 49 + 2 * 49 * 49);
  EXPECT_FALSE(eight.has_edge_set("bend"));
}

TEST(ClothGrid, AnInnerNodeHasAsManyNeighborsAsTheStencilSays) {
  const std::vector<std::pair<GridStencil, int>> stencils = {{GridStencil::k24Neighbour, 24},
                                                             {GridStencil::k12Neighbour, 12},
                                                             {GridStencil::k8Neighbour, 8}};
  for (const auto& [stencil, expected] : stencils) {
    const ClothGrid grid = classic(stencil);
    const std::vector<int> count = neighbors(make_cloth_grid(grid));
    for (int j = 2; j < 48; ++j) {
      for (int i = 2; i < 48; ++i) {
        ASSERT_EQ(count[static_cast<std::size_t>(grid_node(grid, i, j))], expected);
      }
    }
  }
}

TEST(ClothGrid, TheStepsOfAStencilAreOneOfEachPairOfNeighborsInTheOrderOfTheSets) {
  for (const auto& [stencil, neighbors] : {std::pair{GridStencil::k24Neighbour, 24U},
                                           {GridStencil::k12Neighbour, 12U},
                                           {GridStencil::k8Neighbour, 8U}}) {
    const ClothMesh mesh = make_cloth_grid(classic(stencil));
    const std::vector<GridEdgeSet> sets = grid_edge_sets(stencil);
    ASSERT_EQ(mesh.edge_sets.size(), sets.size());
    std::set<std::array<int, 2>> both_ways;
    for (std::size_t s = 0; s < sets.size(); ++s) {
      EXPECT_EQ(mesh.edge_sets[s].name, sets[s].name);
      for (const auto& [i, j] : sets[s].steps) both_ways.insert({{i, j}, {-i, -j}});
    }
    EXPECT_EQ(both_ways.size(), neighbors);
  }
}

TEST(ClothGrid, EverySpringAppearsOnceWithItsLowerNodeFirst) {
  const ClothMesh mesh = make_cloth_grid(classic(GridStencil::k24Neighbour));
  std::set<std::pair<int, int>> seen;
  for (const EdgeSet& set : mesh.edge_sets) {
    for (const auto edge : set.edges.colwise()) {
      EXPECT_LT(edge[0], edge[1]);
      EXPECT_GE(edge[0], 0);
      EXPECT_LT(edge[1], mesh.num_nodes());
      EXPECT_TRUE(seen.emplace(edge[0], edge[1]).second) << set.name << " repeats an edge";
    }
  }
}

TEST(ClothGrid, EdgeSetsHoldTheLengthsTheyAreNamedFor) {
  ClothGrid grid = classic(GridStencil::k24Neighbour);
  grid.size = {4.9, 4.9};  // spacing 0.1 m
  const ClothMesh mesh = make_cloth_grid(grid);
  const auto lengths = [&](const char* set) {
    return VectorX<double>(edge_lengths(mesh.rest_positions, mesh.edges_of({set})) / 0.1);
  };
  EXPECT_NEAR(lengths("stretch").minCoeff(), 1.0, kSumRoundoff);
  EXPECT_NEAR(lengths("stretch").maxCoeff(), 1.0, kSumRoundoff);
  EXPECT_NEAR(lengths("shear").minCoeff(), std::sqrt(2.0), kSumRoundoff);
  EXPECT_NEAR(lengths("shear").maxCoeff(), std::sqrt(2.0), kSumRoundoff);
  EXPECT_NEAR(lengths("bend").minCoeff(), 2.0, kSumRoundoff);
  EXPECT_NEAR(lengths("bend").maxCoeff(), std::sqrt(8.0), kSumRoundoff);
}

TEST(ClothGrid, TrianglesFaceTheFrontAndCoverTheSheetOnce) {
  ClothGrid grid;
  grid.nodes = {6, 5};
  grid.size = {1.5, 0.8};
  grid.u_axis = {1, 2, 2};
  grid.v_axis = {2, 1, -2};
  const ClothMesh mesh = make_cloth_grid(grid);
  const Vector3<double> front = grid.u_axis.cross(grid.v_axis).normalized();
  double area = 0;
  for (const auto t : mesh.triangles.colwise()) {
    const Vector3<double> a = mesh.rest_positions.col(t[0]);
    const Vector3<double> b = mesh.rest_positions.col(t[1]);
    const Vector3<double> c = mesh.rest_positions.col(t[2]);
    const double signed_area = 0.5 * (b - a).cross(c - a).dot(front);
    EXPECT_GT(signed_area, 0);
    area += signed_area;
  }
  EXPECT_NEAR(area, 1.5 * 0.8, kSumRoundoff);
  EXPECT_NEAR(node_areas(mesh).sum(), 1.5 * 0.8, kSumRoundoff);
}

TEST(ClothGrid, DiagonalsAlternateLikeAUnionJack) {
  ClothGrid grid;
  grid.nodes = {7, 7};
  const ClothMesh mesh = make_cloth_grid(grid);
  std::vector<int> triangles(49, 0);
  for (const int node : mesh.triangles.reshaped()) ++triangles[static_cast<std::size_t>(node)];
  for (int j = 1; j < 6; ++j) {
    for (int i = 1; i < 6; ++i) {
      const int expected = (i + j) % 2 == 0 ? 8 : 4;
      EXPECT_EQ(triangles[static_cast<std::size_t>(grid_node(grid, i, j))], expected);
    }
  }
}

TEST(ClothGrid, MassesSumToTheTotal) {
  for (const MassLumping lumping : {MassLumping::kArea, MassLumping::kUniform}) {
    ClothGrid grid = classic(GridStencil::k8Neighbour);
    grid.total_mass = 0.4;
    grid.lumping = lumping;
    const ClothMesh mesh = make_cloth_grid(grid);
    EXPECT_NEAR(mesh.masses.sum(), 0.4, kSumRoundoff);
    EXPECT_GT(mesh.masses.minCoeff(), 0);
  }
}

TEST(ClothGrid, AreaLumpingGivesRimsAHalfAndCornersAQuarter) {
  ClothGrid grid = classic(GridStencil::k8Neighbour);
  const ClothMesh mesh = make_cloth_grid(grid);
  const double inner = mesh.masses[grid_node(grid, 10, 10)];
  for (const auto& [i, j] : {std::pair{0, 0}, {0, -1}, {-1, 0}, {-1, -1}}) {
    EXPECT_DOUBLE_EQ(mesh.masses[grid_node(grid, i, j)], inner / 4);
  }
  EXPECT_DOUBLE_EQ(mesh.masses[grid_node(grid, 0, 10)], inner / 2);
  EXPECT_DOUBLE_EQ(mesh.masses[grid_node(grid, 10, -1)], inner / 2);
  grid.lumping = MassLumping::kUniform;
  const ClothMesh uniform = make_cloth_grid(grid);
  EXPECT_EQ(uniform.masses.minCoeff(), uniform.masses.maxCoeff());
}

TEST(ClothGrid, AxesAreNormalisedAndIndicesRunAlongThem) {
  ClothGrid grid;
  grid.nodes = {3, 5};
  grid.size = {2.0, 4.0};
  grid.center = {1, 2, 3};
  grid.u_axis = {0, 10, 0};
  grid.v_axis = {0, 0, 0.5};
  const ClothMesh mesh = make_cloth_grid(grid);
  const auto at = [&](int i, int j) {
    return Vector3<double>(mesh.rest_positions.col(grid_node(grid, i, j)));
  };
  EXPECT_EQ(at(0, 0), Vector3<double>(1, 1, 1));
  EXPECT_EQ(at(1, 2), grid.center);
  EXPECT_EQ(at(2, 0), Vector3<double>(1, 3, 1));
  EXPECT_EQ(at(-1, -1), Vector3<double>(1, 3, 5));
}

TEST(ClothGrid, NodesOutsideAreRefused) {
  const ClothGrid grid = classic(GridStencil::k8Neighbour);
  EXPECT_EQ(grid_node(grid, 3, 2), 2 * 50 + 3);
  EXPECT_EQ(grid_node(grid, -1, -1), 2499);
  EXPECT_THROW((void)grid_node(grid, 50, 0), InvalidArgument);
  EXPECT_THROW((void)grid_node(grid, 0, -51), InvalidArgument);
}

TEST(ClothGrid, TheSmallestGridIsOneCell) {
  const ClothMesh mesh = make_cloth_grid({});
  EXPECT_EQ(mesh.num_nodes(), 4);
  EXPECT_EQ(mesh.num_edges(), 6);
  EXPECT_EQ(mesh.edges_of({"bend"}).cols(), 0);
}

TEST(ClothGrid, ValuesOutsideTheirDomainAreRefusedByName) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  ClothGrid grid;
  grid.nodes = {1, 5};
  EXPECT_THAT(error_of(grid), HasSubstr("nodes = 1, expected >= 2"));
  grid = {};
  grid.nodes = {100'000, 100'000};
  EXPECT_THAT(error_of(grid), HasSubstr("at most 1e8"));
  grid = {};
  grid.size = {1.0, 0.0};
  EXPECT_THAT(error_of(grid), HasSubstr("size = 0.000000 [m]"));
  grid.size = {nan, 1.0};
  EXPECT_THAT(error_of(grid), HasSubstr("size = nan [m]"));
  grid = {};
  grid.total_mass = -1;
  EXPECT_THAT(error_of(grid), HasSubstr("total_mass = -1.000000 [kg]"));
  grid = {};
  grid.center[1] = nan;
  EXPECT_THAT(error_of(grid), HasSubstr("center"));
  grid = {};
  grid.u_axis.setZero();
  EXPECT_THAT(error_of(grid), HasSubstr("u_axis"));
  grid = {};
  grid.v_axis = {0.1, 0, -1};
  EXPECT_THAT(error_of(grid), HasSubstr("perpendicular"));
}

TEST(ClothMesh, UnknownEdgeSetsAreRefusedAndTheKnownOnesListed) {
  const ClothMesh mesh = make_cloth_grid({});
  EXPECT_TRUE(mesh.has_edge_set("shear"));
  try {
    (void)mesh.edges_of({"stretch", "sheer"});
    FAIL();
  } catch (const InvalidArgument& error) {
    EXPECT_THAT(error.what(), HasSubstr("'sheer' is unknown"));
    EXPECT_THAT(error.what(), HasSubstr("stretch, shear, bend"));
  }
}

TEST(ClothMesh, EdgesOfSeveralSetsFollowOneAnother) {
  const ClothMesh mesh = make_cloth_grid({});
  const Edges edges = mesh.edges_of({"shear", "stretch"});
  ASSERT_EQ(edges.cols(), 6);
  EXPECT_EQ(Edges(edges.leftCols(2)), mesh.edges_of({"shear"}));
  EXPECT_EQ(Edges(edges.rightCols(4)), mesh.edges_of({"stretch"}));
}

}  // namespace
}  // namespace weft
