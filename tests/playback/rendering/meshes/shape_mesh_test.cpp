#include <weft/playback/rendering/meshes/shape_mesh.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <weft/playback/rendering/meshes/tube_mesh.hpp>

namespace weft::scenes {
namespace {

constexpr double kPi = std::numbers::pi;

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

/// Normals of the vertices look to the same side as the triangles.
bool normals_look_outwards(const SurfaceMesh& mesh) {
  for (std::size_t k = 0; k < mesh.indices.size(); k += 3) {
    const SurfaceVertex& a = mesh.vertices[mesh.indices[k]];
    const SurfaceVertex& b = mesh.vertices[mesh.indices[k + 1]];
    const SurfaceVertex& c = mesh.vertices[mesh.indices[k + 2]];
    const Eigen::Vector3f front = (b.position - a.position).cross(c.position - a.position);
    if (front.dot(a.normal + b.normal + c.normal) < 0.0f) return false;
  }
  return true;
}

/// 96 sides around lose (2 pi / 96)^2 / 6 = 0.07 % of the area of a circle, and rows of 1/48 of a
/// half turn as much again.
constexpr double kFacets = 2e-3;

TEST(ShapeMesh, BoxHasItsVolumeAndFacesOutwards) {
  const SurfaceMesh box = box_surface({0.5, 1.0, 2.0});
  // Vertices are stored in single precision.
  EXPECT_NEAR(volume(box), 8.0, 8.0 * 64 * std::numeric_limits<float>::epsilon());
  EXPECT_TRUE(normals_look_outwards(box));
}

TEST(ShapeMesh, RoundBodiesHaveTheirVolumeUpToTheirFacets) {
  const struct {
    const char* name;
    SurfaceMesh mesh;
    double volume;
  } bodies[] = {
      {"sphere", sphere_surface(2.0), 4.0 / 3.0 * kPi * 8.0},
      {"capsule", capsule_surface(0.5, 1.5), kPi * 0.25 * 3.0 + 4.0 / 3.0 * kPi * 0.125},
      {"cylinder", cylinder_surface(0.5, 1.5), kPi * 0.25 * 3.0},
      {"cone", cone_surface(0.5, 1.5), kPi * 0.25 * 3.0 / 3.0},
  };
  for (const auto& body : bodies) {
    EXPECT_LT(volume(body.mesh), body.volume) << body.name;
    EXPECT_GT(volume(body.mesh), body.volume * (1.0 - kFacets)) << body.name;
    EXPECT_TRUE(normals_look_outwards(body.mesh)) << body.name;
  }
}

/// A cube of 12 triangles.
struct Cube {
  Matrix3X<double> points{3, 8};
  Triangles triangles{3, 12};
  Cube() {
    points << 0, 1, 0, 1, 0, 1, 0, 1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 0, 0, 1, 1, 1, 1;
    triangles << 0, 0, 4, 4, 0, 0, 2, 2, 0, 0, 1, 1, 3, 2, 5, 7, 1, 5, 6, 7, 4, 6, 3, 7, 1, 3, 7, 6,
        5, 4, 7, 3, 6, 2, 7, 5;
  }
};

TEST(ShapeMesh, EdgesOfACubeAreSharpAndThoseOfASmoothSurfaceAreNot) {
  const Cube cube;
  const SurfaceMesh sharp = triangle_surface(cube.points, cube.triangles, 0.5);
  EXPECT_NEAR(volume(sharp), 1.0, 1e-5);
  for (const SurfaceVertex& vertex : sharp.vertices) {
    EXPECT_NEAR(vertex.normal.cwiseAbs().maxCoeff(), 1.0f, 1e-6f);
  }
  const SurfaceMesh smooth = triangle_surface(cube.points, cube.triangles, kPi);
  for (const SurfaceVertex& vertex : smooth.vertices) {
    EXPECT_LT(vertex.normal.cwiseAbs().maxCoeff(), 0.95f);
  }
}

TEST(ShapeMesh, PartsStandWhereTheirPoseSays) {
  SurfaceMesh two = box_surface({0.5, 0.5, 0.5});
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translate(Eigen::Vector3d(3, 0, 0));
  append_surface(two, box_surface({0.5, 0.5, 0.5}), pose);
  EXPECT_NEAR(volume(two), 2.0, 1e-5);
  EXPECT_NEAR(two.vertices.back().position.x(), 3.0f, 0.51f);
}

struct TubeMeshTest : testing::Test {
  Matrix3X<double> positions{3, 5};
  Edges edges{2, 4};
  TubeMeshTest() {
    positions << 0, 1, 2, 3, 4, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0;
    edges << 0, 1, 2, 3, 1, 2, 3, 4;
  }
};

TEST_F(TubeMeshTest, StraightRopeIsACapsule) {
  const SurfaceMesh tube = tube_surface(edges, positions, 0.1, {});
  // A polygon of 14 sides in place of a circle: sin(2 pi / 14) 14 / (2 pi) = 0.967 of its area.
  const double exact = kPi * 0.01 * 4.0 + 4.0 / 3.0 * kPi * 0.001;
  EXPECT_LT(volume(tube), exact);
  EXPECT_GT(volume(tube), 0.95 * exact);
  EXPECT_TRUE(normals_look_outwards(tube));
  EXPECT_EQ(tube.nodes.size(), tube.vertices.size());
}

TEST_F(TubeMeshTest, NodeThatIsNotFiniteLeavesAGap) {
  const double whole = volume(tube_surface(edges, positions, 0.1, {}));
  positions(1, 2) = std::numeric_limits<double>::quiet_NaN();
  const SurfaceMesh tube = tube_surface(edges, positions, 0.1, {});
  EXPECT_LT(volume(tube), 0.6 * whole);
  for (const SurfaceVertex& vertex : tube.vertices) EXPECT_TRUE(vertex.position.allFinite());
}

TEST(TubeMesh, RingsAndJunctionsHaveEveryEdgeOnce) {
  // A ring of 24 edges with a tail of one.
  constexpr int kRing = 24;
  constexpr double kRadius = 0.02;
  Matrix3X<double> positions(3, kRing + 1);
  Edges edges(2, kRing + 1);
  for (int i = 0; i < kRing; ++i) {
    const double angle = 2.0 * kPi * i / kRing;
    positions.col(i) << std::cos(angle), 0.0, std::sin(angle);
    edges.col(i) << std::min(i, (i + 1) % kRing), std::max(i, (i + 1) % kRing);
  }
  positions.col(kRing) << 2.0, 0.0, 0.0;
  edges.col(kRing) << 0, kRing;
  const double length = 2.0 * kRing * std::sin(kPi / kRing) + 1.0;
  const double exact = kPi * kRadius * kRadius * length;
  // 3.3 % for the polygon of 14 sides; half balls at four ends add 1.5 %.
  EXPECT_NEAR(volume(tube_surface(edges, positions, kRadius, {})), exact, 0.05 * exact);
}

}  // namespace
}  // namespace weft::scenes
