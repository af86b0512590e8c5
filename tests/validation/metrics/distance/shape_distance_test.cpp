#include <weft/validation/metrics/distance/shape_distance.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <weft/scenes/shapes/shape_surface.hpp>
#include <weft/validation/metrics/distance/surface_index.hpp>

namespace weft::validation {
namespace {

using namespace scenes;

ConvexHullShape cube_points(double half) {
  ConvexHullShape hull{Matrix3X<double>(3, 8)};
  for (int i = 0; i < 8; ++i) {
    hull.points.col(i) =
        half * Vector3<double>((i & 1) ? 1 : -1, (i & 2) ? 1 : -1, (i & 4) ? 1 : -1);
  }
  return hull;
}

HeightFieldShape ridge() {
  HeightFieldShape field{{4.0, 4.0}, Eigen::MatrixXd::Zero(9, 9)};
  field.heights.col(4).setConstant(0.5);
  return field;
}

CompoundShape two_balls() {
  return {{{SphereShape{0.4}, {-0.3, 0, 0}}, {SphereShape{0.4}, {0.3, 0, 0}}}};
}

struct Sample {
  std::string name;
  Shape shape;
};

std::vector<Sample> closed_shapes() {
  return {{"sphere", SphereShape{0.7}},
          {"box", BoxShape{{0.5, 0.7, 0.3}}},
          {"capsule", CapsuleShape{0.3, 0.8}},
          {"cylinder", CylinderShape{0.5, 0.9}},
          {"cone", ConeShape{0.6, 1.1}},
          {"hull", cube_points(0.6)},
          {"mesh", shape_surface(BoxShape{{0.5, 0.7, 0.3}})},
          {"compound", two_balls()}};
}

/// Whether a point is inside a closed surface of triangles: the solid angle it sees, 4 pi or 0
/// (Van Oosterom and Strackee 1983). Of a compound's parts, the number of those around it.
double winding(const MeshShape& mesh, const Vector3<double>& point) {
  double angle = 0.0;
  for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
    const Vector3<double> a = mesh.points.col(mesh.triangles(0, t)) - point;
    const Vector3<double> b = mesh.points.col(mesh.triangles(1, t)) - point;
    const Vector3<double> c = mesh.points.col(mesh.triangles(2, t)) - point;
    const double la = a.norm();
    const double lb = b.norm();
    const double lc = c.norm();
    angle += 2.0 * std::atan2(a.dot(b.cross(c)),
                              la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return angle / (4.0 * std::numbers::pi);
}

// A polyhedron of 100 sides lies up to R (1 - cos(pi / 100)) = 4.9e-4 R inside a round
// surface, where it is curved both ways twice that.
constexpr int kDivisions = 100;
constexpr double kRoundness = 1.1e-3;  // [m]

TEST(ShapeDistance, IsTheDistanceToTheTrianglesOfTheSurface) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> coordinate(-1.2, 1.2);
  for (const Sample& sample : closed_shapes()) {
    const ShapeDistance distance(sample.shape);
    const MeshShape mesh = shape_surface(sample.shape, kDivisions);
    const SurfaceIndex surface(mesh.points, mesh.triangles);
    for (int i = 0; i < 120; ++i) {
      const Vector3<double> point(coordinate(random), coordinate(random), coordinate(random));
      const double measured = distance(point);
      const double nearest = surface.distance(point);
      if (nearest < 2 * kRoundness) continue;  // either side, within the roundness
      const bool is_inside = winding(mesh, point) > 0.5;
      EXPECT_EQ(measured < 0, is_inside) << sample.name << " at " << point.transpose();
      // Inside a compound the hidden surfaces of its parts are near too.
      if (is_inside && sample.name == "compound") {
        EXPECT_LE(measured, -nearest + kRoundness) << point.transpose();
      } else {
        EXPECT_NEAR(std::abs(measured), nearest, kRoundness)
            << sample.name << " at " << point.transpose();
      }
    }
  }
}

TEST(ShapeDistance, HasItsZeroOnTheSurface) {
  // Rounding of a few lengths of 1 m.
  constexpr double kRounding = 1e-12;
  EXPECT_NEAR(ShapeDistance(CapsuleShape{0.3, 0.8})({0, 0.7, 0}), 0.0, kRounding);
  EXPECT_NEAR(ShapeDistance(CylinderShape{0.5, 0.9})({0.3, 0.45, 0.4}), 0.0, kRounding);
  EXPECT_NEAR(ShapeDistance(ConeShape{0.6, 1.2})({0.3, 0, 0}), 0.0, kRounding);
  EXPECT_NEAR(ShapeDistance(ConeShape{0.6, 1.2})({0, 0.6, 0}), 0.0, kRounding);
  EXPECT_NEAR(ShapeDistance(cube_points(0.6))({0.6, 0.1, 0.2}), 0.0, kRounding);
  EXPECT_NEAR(ShapeDistance(two_balls())({0.7, 0, 0}), 0.0, kRounding);
  EXPECT_NEAR(ShapeDistance(ridge())({0, 0.5, 0.3}), 0.0, kRounding);
}

TEST(ShapeDistance, GroundIsSolidBelowItsHeights) {
  const ShapeDistance distance(ridge());
  EXPECT_NEAR(distance({1.5, 0.2, 0.1}), 0.2, 1e-12);
  EXPECT_NEAR(distance({1.5, -0.2, 0.1}), -0.2, 1e-12);
  EXPECT_GT(distance({2.5, -3.0, 0.1}), 0.0);  // beside it
  EXPECT_GT(distance({0, 0.6, 0.1}), 0.0);
  EXPECT_LT(distance({0, 0.4, 0.1}), 0.0);
  // Beside the ridge: 45 degrees steep, so the distance is that to its side.
  EXPECT_NEAR(distance({0.5, 0.5, 0.1}), 0.5 / std::numbers::sqrt2, 1e-12);
}

TEST(ShapeDistance, SignIsRightAtCornersAndEdgesOfAMesh) {
  // The nearest place is a corner or an edge, where triangles of several normals are equally near.
  const ShapeDistance distance(shape_surface(BoxShape{{0.5, 0.5, 0.5}}));
  EXPECT_NEAR(distance({0.8, 0.8, 0.8}), 0.3 * std::numbers::sqrt3, 1e-12);
  EXPECT_NEAR(distance({0.8, 0.8, 0.0}), 0.3 * std::numbers::sqrt2, 1e-12);
  EXPECT_NEAR(distance({0.4, 0.4, 0.4}), -0.1, 1e-12);
}

TEST(ShapeSurface, VolumesAndInertiasAreThoseOfTheSolids) {
  constexpr double kShare = 0.004;  // of 96 sides: 2 pi^2 / (3 96^2) for a circle's area and more
  const double pi = std::numbers::pi;
  const auto near = [&](double value, double expected) {
    EXPECT_NEAR(value, expected, kShare * std::abs(expected));
  };
  const SolidMoments cylinder = solid_moments(CylinderShape{0.5, 2.0});
  near(cylinder.volume, pi * 0.25 * 2.0);
  near(cylinder.inertia.y(), 0.5 * 0.25);
  near(cylinder.inertia.x(), 0.25 * 0.25 + 4.0 / 12.0);
  const SolidMoments cone = solid_moments(ConeShape{0.5, 2.0});
  near(cone.volume, pi * 0.25 * 2.0 / 3.0);
  near(cone.center.y(), -0.5);
  near(cone.inertia.y(), 0.3 * 0.25);
  const SolidMoments capsule = solid_moments(CapsuleShape{0.5, 2.0});
  near(capsule.volume, pi * 0.25 * 2.0 + 4.0 / 3.0 * pi * 0.125);
  const SolidMoments cube = solid_moments(cube_points(0.6));
  EXPECT_NEAR(cube.volume, 1.728, 1e-12);
  EXPECT_NEAR(cube.inertia.x(), 2.0 * 0.36 / 3.0, 1e-12);
  EXPECT_THROW((void)solid_moments(PlaneShape{}), std::exception);
}

TEST(ShapeSurface, HullLeavesOutPointsInsideAndOnFaces) {
  ConvexHullShape hull = cube_points(1.0);
  hull.points.conservativeResize(3, 11);
  hull.points.col(8) = Vector3<double>(0.1, 0.2, 0.3);   // inside
  hull.points.col(9) = Vector3<double>(1.0, 0.2, 0.3);   // on a face
  hull.points.col(10) = Vector3<double>(1.0, 1.0, 0.3);  // on an edge
  EXPECT_EQ(hull_surface(hull).triangles.cols(), 12);
  hull.points.row(1).setZero();
  EXPECT_THROW((void)hull_surface(hull), std::exception);
}

}  // namespace
}  // namespace weft::validation
