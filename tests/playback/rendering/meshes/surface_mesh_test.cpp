#include <weft/playback/rendering/meshes/surface_mesh.hpp>

#include <gtest/gtest.h>

#include <limits>

namespace weft::scenes {
namespace {

TEST(SurfaceMesh, LeavesOutTrianglesWithNodesThatAreNotFinite) {
  Matrix3X<double> positions(3, 4);
  positions << 0, 1, 1, 0, 0, 0, 0, 0, 0, 0, -1, -1;
  Triangles triangles(3, 2);
  triangles << 0, 0, 1, 2, 2, 3;
  EXPECT_EQ(cloth_surface(triangles, positions, {}).indices.size(), 6u);
  positions(0, 3) = std::numeric_limits<double>::quiet_NaN();
  const SurfaceMesh mesh = cloth_surface(triangles, positions, {});
  EXPECT_EQ(mesh.indices.size(), 3u);
  for (const SurfaceVertex& vertex : mesh.vertices) EXPECT_TRUE(vertex.position.allFinite());
  EXPECT_EQ(mesh.vertices[0].normal, Eigen::Vector3f(0, 1, 0));
}

}  // namespace
}  // namespace weft::scenes
