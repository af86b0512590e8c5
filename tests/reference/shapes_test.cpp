// Signed distances of the shapes beside sphere, box and plane (contact_test.cpp).
#include <cmath>
#include <functional>
#include <memory>

#include <gtest/gtest.h>

#include <weft/core/error.hpp>
#include <weft/mesh/icosphere.hpp>
#include <weft/reference/contact/distance/mesh_surface.hpp>
#include <weft/reference/contact/distance/signed_distance.hpp>

#include "tests/reference/fixed_numbers.hpp"
#include "tests/reference/small_systems.hpp"

namespace weft::reference::testing {
namespace {

using Vec = Vector3<double>;

constexpr double kRadius = 0.4, kHeight = 0.9;  // [m]

/// A solid of revolution: its outline in (r, y) as polyline corners from axis to axis, and whether a
/// point of the half plane is inside.
struct Solid {
  const char* name;
  Shape shape;
  std::vector<Eigen::Vector2d> outline;
  std::function<bool(double, double)> is_inside;
};

std::vector<Solid> solids() {
  const double half = kHeight / 2;
  std::vector<Eigen::Vector2d> caps;
  constexpr int kArc = 20000;  // chords err by r (pi / 2 / kArc)^2 / 8 = 3e-10 m
  for (int i = 0; i <= kArc; ++i) {
    const double a = M_PI / 2 * i / kArc;
    caps.emplace_back(kRadius * std::sin(a), half + kRadius * std::cos(a));
  }
  for (int i = kArc; i >= 0; --i) caps.emplace_back(caps[static_cast<std::size_t>(i)].x(), 0);
  for (int i = 0; i <= kArc; ++i) {
    caps[static_cast<std::size_t>(kArc + 1 + i)].y() =
        -caps[static_cast<std::size_t>(kArc - i)].y();
  }
  return {
      {"capsule", Capsule{kRadius, kHeight}, caps,
       [=](double r, double y) { return std::hypot(r, y - std::clamp(y, -half, half)) < kRadius; }},
      {"cylinder",
       Cylinder{kRadius, kHeight},
       {{0, half}, {kRadius, half}, {kRadius, -half}, {0, -half}},
       [=](double r, double y) { return r < kRadius && std::abs(y) < half; }},
      {"cone",
       Cone{kRadius, kHeight},
       {{0, half}, {kRadius, -half}, {0, -half}},
       [=](double r, double y) { return y > -half && r < kRadius * (half - y) / kHeight; }}};
}

double distance_to_outline(const std::vector<Eigen::Vector2d>& outline, const Eigen::Vector2d& p) {
  double least = 1e300;
  for (std::size_t i = 0; i + 1 < outline.size(); ++i) {
    const Eigen::Vector2d edge = outline[i + 1] - outline[i];
    const double part = std::clamp((p - outline[i]).dot(edge) / edge.squaredNorm(), 0.0, 1.0);
    least = std::min(least, (outline[i] + part * edge - p).norm());
  }
  return least;
}

TEST(SignedDistance, OfSolidsOfRevolutionIsThatToTheirOutline) {
  const Pose pose{{0.3, -0.2, 0.1},
                  Eigen::Quaterniond(Eigen::AngleAxisd(0.7, Vec(1, -2, 3).normalized()))};
  for (const Solid& solid : solids()) {
    Numbers numbers;
    int inside = 0;
    for (int i = 0; i < 300; ++i) {
      const Vec body = 0.9 * numbers.vector();
      const double r = std::hypot(body.x(), body.z());
      const SurfaceDistance found =
          signed_distance(solid.shape, pose, pose.position + pose.orientation * body);
      const double size = distance_to_outline(solid.outline, {r, body.y()});
      const bool is_inside = solid.is_inside(r, body.y());
      inside += is_inside;
      EXPECT_NEAR(found.distance, is_inside ? -size : size, 1e-9) << solid.name;
      // The normal leads to the surface: there the distance is 0.
      EXPECT_NEAR(found.normal.norm(), 1.0, 1e-14);
      const Vec foot = pose.position + pose.orientation * body - found.distance * found.normal;
      EXPECT_NEAR(signed_distance(solid.shape, pose, foot).distance, 0.0, 1e-14) << solid.name;
    }
    EXPECT_GT(inside, 5) << solid.name;
  }
}

/// A prism over a counter-clockwise polygon in (x, y), from z = -d to d; caps as fans of given
/// triangles.
MeshSurface prism(const std::vector<Eigen::Vector2d>& polygon,
                  const std::vector<std::array<int, 3>>& cap, double d) {
  const int n = static_cast<int>(polygon.size());
  Matrix3X<double> points(3, 2 * n);
  std::vector<std::array<int, 3>> list;
  for (int i = 0; i < n; ++i) {
    points.col(i) << polygon[static_cast<std::size_t>(i)], -d;
    points.col(n + i) << polygon[static_cast<std::size_t>(i)], d;
    const int j = (i + 1) % n;
    list.push_back({i, j, n + j});
    list.push_back({i, n + j, n + i});
  }
  for (const auto& [a, b, c] : cap) {
    list.push_back({n + a, n + b, n + c});
    list.push_back({a, c, b});
  }
  Triangles triangles(3, static_cast<Eigen::Index>(list.size()));
  for (std::size_t t = 0; t < list.size(); ++t) {
    triangles.col(static_cast<Eigen::Index>(t)) << list[t][0], list[t][1], list[t][2];
  }
  return {points, triangles};
}

TEST(MeshSurface, OfABoxIsTheBox) {
  const Vec half(0.3, 0.2, 0.5);
  const MeshSurface mesh =
      prism({{-0.3, -0.2}, {0.3, -0.2}, {0.3, 0.2}, {-0.3, 0.2}}, {{0, 1, 2}, {0, 2, 3}}, half.z());
  const Pose origin{Vec::Zero(), Eigen::Quaterniond::Identity()};
  Numbers numbers;
  for (int i = 0; i < 1000; ++i) {
    const Vec point = 0.8 * numbers.vector();
    const SurfaceDistance box = signed_distance(Box{half}, origin, point);
    const SurfaceDistance found = mesh.distance(point);
    EXPECT_NEAR(found.distance, box.distance, 1e-15);
    EXPECT_LT((found.normal - box.normal).norm(), 1e-12);
  }
}

TEST(MeshSurface, OfAnAngleIsTheUnionOfItsArmsOutside) {
  // An L: two boxes. Outside, the distance to a union is the least of the two.
  const MeshSurface mesh = prism({{0, 0}, {1, 0}, {1, 0.3}, {0.3, 0.3}, {0.3, 1}, {0, 1}},
                                 {{0, 1, 2}, {0, 2, 3}, {0, 3, 5}, {3, 4, 5}}, 0.2);
  const Pose lying{{0.5, 0.15, 0}, Eigen::Quaterniond::Identity()};
  const Pose standing{{0.15, 0.5, 0}, Eigen::Quaterniond::Identity()};
  Numbers numbers;
  int inside = 0;
  for (int i = 0; i < 1000; ++i) {
    const Vec point = Vec(0.4, 0.4, 0) + numbers.vector();
    const double a = signed_distance(Box{{0.5, 0.15, 0.2}}, lying, point).distance;
    const double b = signed_distance(Box{{0.15, 0.5, 0.2}}, standing, point).distance;
    const double found = mesh.distance(point).distance;
    if (std::min(a, b) > 0.0) {
      EXPECT_NEAR(found, std::min(a, b), 1e-15);
    } else {
      ++inside;
      EXPECT_LE(found, std::max(std::min(a, b), -0.3) + 1e-15) << "deeper than its deeper arm";
    }
  }
  EXPECT_GT(inside, 20);
}

TEST(MeshSurface, WithItsPointsRepeatedAlongSeamsIsTheSame) {
  const ClothMesh ball = make_icosphere({.frequency = 2});
  const MeshSurface shared(ball.rest_positions, ball.triangles);
  Matrix3X<double> points(3, 3 * ball.triangles.cols());
  Triangles triangles = ball.triangles;
  for (Eigen::Index i = 0; i < triangles.size(); ++i) {
    points.col(i) = ball.rest_positions.col(triangles.data()[i]);
    triangles.data()[i] = static_cast<int>(i);
  }
  const MeshSurface repeated(points, triangles);
  const Vec point(0.2, -0.9, 0.7);
  EXPECT_EQ(repeated.distance(point).distance, shared.distance(point).distance);
  EXPECT_EQ(repeated.distance(point).normal, shared.distance(point).normal);
}

TEST(MeshSurface, ThatIsNotClosedOrRunsTwoWaysIsRefused) {
  ClothMesh ball = make_icosphere({.frequency = 2});
  EXPECT_NO_THROW((void)MeshSurface(ball.rest_positions, ball.triangles));
  const Triangles open = ball.triangles.leftCols(ball.triangles.cols() - 1);
  EXPECT_THROW((void)MeshSurface(ball.rest_positions, open), InvalidArgument);
  Triangles turned = ball.triangles;
  std::swap(turned(0, 3), turned(1, 3));
  EXPECT_THROW((void)MeshSurface(ball.rest_positions, turned), InvalidArgument);
}

TEST(Shapes, ACapsuleWithoutATubeTurnsAsABallAndALongOneAsARod) {
  Collider ball{.name = "ball", .shape = Capsule{0.5, 1e-12}, .mass = 2.0};
  EXPECT_LT((principal_inertia(ball) - Vec::Constant(0.4 * 2.0 * 0.25)).norm(), 1e-11);
  Collider rod{.name = "rod", .shape = Cylinder{1e-9, 3.0}, .mass = 2.0};
  EXPECT_NEAR(principal_inertia(rod).x(), 2.0 * 9.0 / 12.0, 1e-14);
}

/// A node that slides down every shape: never inside, and it does come down.
TEST(Shapes, ANodeGlidesOverEveryShapeWithoutEnteringIt) {
  ClothMesh ball = make_icosphere({.radius = 0.4, .frequency = 3});
  const auto mesh = std::make_shared<const MeshSurface>(ball.rest_positions, ball.triangles);
  for (const Shape& shape : {Shape(Capsule{kRadius, kHeight}), Shape(Cylinder{kRadius, kHeight}),
                             Shape(Cone{kRadius, kHeight}), Shape(Mesh{mesh})}) {
    for (const IntegratorKind integrator :
         {IntegratorKind::kModifiedEuler, IntegratorKind::kTrBdf2}) {
      System system = system_of(make_free_node(0.1, {0.13, 0.95, 0.05}, {0, -9.81, 0}));
      system.bodies[0].collision_margin = 0.02;
      Collider collider{.name = "shape", .shape = shape};
      collider.velocity = {0.1, 0.05, 0};  // a moving version
      collider.angular_velocity = {0.3, -0.2, 0.5};
      system.colliders.push_back(collider);
      SpringSolver solver(std::move(system), {.integrator = integrator});
      bool touched = false;
      for (int n = 0; n < 1000; ++n) {
        touched |= solver.step(1e-3).contact.num_contacts > 0;
        const Collider& now = solver.system().colliders[0];
        const Vec node = solver.system().bodies[0].positions.col(0);
        const double distance =
            signed_distance(now.shape, {now.position, now.orientation}, node).distance;
        // Rounding of the linearisation; a mesh of facets bends away by a slip per step.
        ASSERT_GT(distance, 0.02 - 1e-5) << shape.index() << ", step " << n;
      }
      EXPECT_TRUE(touched) << shape.index();
    }
  }
}

}  // namespace
}  // namespace weft::reference::testing
