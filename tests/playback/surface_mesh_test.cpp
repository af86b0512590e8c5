#include <weft/scenes/playback/surface_mesh.hpp>

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <limits>

namespace weft::scenes {
namespace {

/// Signed volume [m^3]: positive only if all triangles face outwards.
double volume(const SurfaceMesh& mesh) {
  double sum = 0.0;
  for (std::size_t k = 0; k < mesh.indices.size(); k += 3) {
    const Eigen::Vector3d a = mesh.vertices[mesh.indices[k]].position.cast<double>();
    const Eigen::Vector3d b = mesh.vertices[mesh.indices[k + 1]].position.cast<double>();
    const Eigen::Vector3d c = mesh.vertices[mesh.indices[k + 2]].position.cast<double>();
    sum += a.dot(b.cross(c)) / 6.0;
  }
  return sum;
}

/// Vertices are stored in single precision.
constexpr double kRoundOff = 64 * std::numeric_limits<float>::epsilon();

TEST(SurfaceMesh, BoxHasItsVolumeAndFacesOutwards) {
  EXPECT_NEAR(volume(box_surface({0.5, 1.0, 2.0})), 8.0, 8.0 * kRoundOff);
}

TEST(SurfaceMesh, SphereHasItsVolumeUpToItsFacets) {
  const double exact = 4.0 / 3.0 * 3.14159265358979 * 8.0;
  // An inscribed polyhedron of angle steps h = 2 pi / 96 loses about h^2 / 4 of the volume.
  constexpr double kFacets = (2.0 * 3.14159265 / 96.0) * (2.0 * 3.14159265 / 96.0) / 2.0;
  EXPECT_LT(volume(sphere_surface(2.0)), exact);
  EXPECT_GT(volume(sphere_surface(2.0)), exact * (1.0 - kFacets));
}

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
