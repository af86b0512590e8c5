#include <cmath>

#include <gtest/gtest.h>
#include <weft/core/error.hpp>
#include <weft/mesh/cloth_grid.hpp>
#include <weft/mesh/icosphere.hpp>
#include <weft/mesh/topology/hinges.hpp>

namespace weft {
namespace {

TEST(Icosphere, HasItsCountsItsRadiusAndItsFront) {
  for (const int f : {1, 2, 5}) {
    const ClothMesh mesh = make_icosphere({.radius = 2.0, .frequency = f, .center = {1, 2, 3}});
    EXPECT_EQ(mesh.num_nodes(), 10 * f * f + 2);
    EXPECT_EQ(mesh.edges_of({"stretch"}).cols(), 30 * f * f);
    EXPECT_EQ(mesh.triangles.cols(), 20 * f * f);
    EXPECT_TRUE(is_closed_surface(mesh.triangles));
    EXPECT_NEAR(mesh.masses.sum(), 1.0, 1e-12);
    const Matrix3X<double> r = mesh.rest_positions.colwise() - Vector3<double>(1, 2, 3);
    EXPECT_LE((r.colwise().norm().array() - 2.0).abs().maxCoeff(), 1e-14);
    const VectorX<double> angles =
        hinge_angles(mesh.rest_positions, hinges_of_triangles(mesh.triangles));
    EXPECT_GT(angles.minCoeff(), 0.0) << "the outside is the front, and convex";
  }
  EXPECT_THROW((void)make_icosphere({.radius = 0.0}), InvalidArgument);
  EXPECT_THROW((void)make_icosphere({.frequency = 0}), InvalidArgument);
}

TEST(Surface, AGridIsOpenAndItsRingsAreFans) {
  ClothGrid grid;
  grid.nodes = {4, 3};
  const ClothMesh mesh = make_cloth_grid(grid);
  EXPECT_FALSE(is_closed_surface(mesh.triangles));
  const std::vector<Ring> found = rings(mesh.triangles, {5, 0});
  EXPECT_FALSE(found[0].is_open);
  EXPECT_EQ(found[0].nodes.size(), 8U) << "an even node of the union jack meets eight triangles";
  EXPECT_TRUE(found[1].is_open);
}

TEST(Surface, TheTwoWaysOfCuttingHaveTheSameAreaAndAllDiagonalsBetweenThem) {
  ClothGrid grid;
  grid.nodes = {6, 5};
  grid.size = {5, 4};
  ClothMesh mesh = make_cloth_grid(grid);
  const double area = node_areas(mesh).sum();
  Triangles both(3, 2 * mesh.triangles.cols());
  both << mesh.triangles, mesh.crossed_triangles;
  EXPECT_EQ(edges_of_triangles(both).cols(), 5 * 5 + 6 * 4 + 2 * 5 * 4);
  mesh.triangles = mesh.crossed_triangles;
  EXPECT_NEAR(node_areas(mesh).sum(), area, 1e-12);
}

TEST(Surface, ANodeWithTwoFansIsRefused) {
  Triangles bow_tie(3, 2);
  bow_tie.col(0) << 0, 1, 2;
  bow_tie.col(1) << 0, 3, 4;
  EXPECT_THROW((void)rings(bow_tie, {0}), InvalidArgument);
}

}  // namespace
}  // namespace weft
