#include <weft/validation/cases/support/decimated_mesh.hpp>

#include <algorithm>

#include <gtest/gtest.h>

#include <weft/core/error.hpp>
#include <weft/mesh/cloth_mesh.hpp>
#include <weft/scenes/catalog.hpp>

namespace weft::validation {
namespace {

ClothMesh drape_mesh() {
  return scenes::make_mesh(scenes::load_scene("drape_sphere").cloths.front());
}

double area(const ClothMesh& mesh, const DecimatedMesh& decimated) {
  double sum = 0.0;
  const auto at = [&](std::size_t corner) {
    const int node = decimated.nodes[static_cast<std::size_t>(decimated.triangles[corner])];
    return Vector3<double>(mesh.rest_positions.col(node));
  };
  for (std::size_t t = 0; t < decimated.triangles.size(); t += 3) {
    sum += 0.5 * (at(t + 1) - at(t)).cross(at(t + 2) - at(t)).norm();
  }
  return sum;
}

TEST(ThinMesh, KeepsASmallMeshAsItIs) {
  const ClothMesh mesh = drape_mesh();
  const DecimatedMesh decimated = decimate(mesh.rest_positions, mesh.triangles, mesh.num_nodes());
  EXPECT_EQ(static_cast<int>(decimated.nodes.size()), mesh.num_nodes());
  EXPECT_EQ(static_cast<Eigen::Index>(decimated.triangles.size()), mesh.triangles.size());
}

TEST(ThinMesh, StaysBelowTheLimitAndCoversTheSameCloth) {
  const ClothMesh mesh = drape_mesh();  // 50 x 50 nodes, 7 m x 7 m
  const DecimatedMesh decimated = decimate(mesh.rest_positions, mesh.triangles, 1500);
  EXPECT_LE(decimated.nodes.size(), 1500U);
  EXPECT_GT(decimated.nodes.size(), 1300U);  // 38 x 38 is the largest square grid below
  EXPECT_TRUE(std::is_sorted(decimated.nodes.begin(), decimated.nodes.end()));
  // A flat cloth whose corners stay has no hole and no overlap if the area is the same; rounding of sums only.
  EXPECT_NEAR(area(mesh, decimated), 49.0, 1e-9);
}

TEST(ThinMesh, NamesOnlyNodesThatItKept) {
  const ClothMesh mesh = drape_mesh();
  const DecimatedMesh decimated = decimate(mesh.rest_positions, mesh.triangles, 100);
  for (const int corner : decimated.triangles) {
    ASSERT_GE(corner, 0);
    ASSERT_LT(corner, static_cast<int>(decimated.nodes.size()));
  }
}

TEST(ThinMesh, OneNodeIsThePossibleEnd) {
  const ClothMesh mesh = drape_mesh();
  const DecimatedMesh decimated = decimate(mesh.rest_positions, mesh.triangles, 1);
  EXPECT_EQ(decimated.nodes.size(), 1U);
  EXPECT_TRUE(decimated.triangles.empty());
  EXPECT_THROW((void)decimate(mesh.rest_positions, mesh.triangles, 0), InvalidArgument);
}

}  // namespace
}  // namespace weft::validation
