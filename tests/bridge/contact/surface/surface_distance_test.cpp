// Distances that contacts are found by, against Bullet's own search (GJK) and against properties that every distance has.
#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/CollisionShapes/btCapsuleShape.h>
#include <BulletCollision/CollisionShapes/btConeShape.h>
#include <BulletCollision/CollisionShapes/btCylinderShape.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkEpa2.h>

#include <weft/bridge/contact/surface/surface_distance.hpp>

#include "tests/bridge/rigid_objects.hpp"

namespace weft::bridge {
namespace {

constexpr double kFar = 100;    ///< [m]
constexpr double kTiny = 1e-4;  ///< [m] margin of shapes that are as large as with it

struct Solid {
  std::string name;
  std::shared_ptr<btConvexShape> shape;
};

std::shared_ptr<btConvexHullShape> hull_of(const std::vector<btVector3>& points, double margin) {
  auto hull = std::make_shared<btConvexHullShape>();
  for (const btVector3& point : points) hull->addPoint(point, false);
  hull->setMargin(static_cast<btScalar>(margin));
  hull->recalcLocalAabb();
  return hull;
}

std::vector<btVector3> random_points(int count) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> at(-0.5, 0.5);
  std::vector<btVector3> points;
  for (int i = 0; i < count; ++i) points.push_back(vector(at(random), at(random), at(random)));
  return points;
}

std::vector<btVector3> prism() {
  return {vector(0, 0, 0),     vector(0.4, 0.1, 0),     vector(0.1, 0.5, 0.1),
          vector(0, 0, -0.15), vector(0.4, 0.1, -0.15), vector(0.1, 0.5, -0.05)};
}

template <class Shape>
std::shared_ptr<btConvexShape> with_margin(std::shared_ptr<Shape> shape, double margin) {
  shape->setMargin(static_cast<btScalar>(margin));
  return shape;
}

std::vector<Solid> named_solids() {
  const auto half = vector(0.3, 0.5, 0.3);
  return {
      {"sphere", std::make_shared<btSphereShape>(btScalar(0.4))},
      {"box", with_margin(std::make_shared<btBoxShape>(vector(0.3, 0.2, 0.5)), kTiny)},
      {"capsule", std::make_shared<btCapsuleShape>(btScalar(0.2), btScalar(0.6))},
      {"capsule_x", std::make_shared<btCapsuleShapeX>(btScalar(0.2), btScalar(0.6))},
      {"cylinder", with_margin(std::make_shared<btCylinderShape>(half), kTiny)},
      {"cylinder_z", with_margin(std::make_shared<btCylinderShapeZ>(vector(0.3, 0.3, 0.5)), kTiny)},
      {"cone", with_margin(std::make_shared<btConeShape>(btScalar(0.3), btScalar(0.7)), 0.01)},
      {"cone_x", with_margin(std::make_shared<btConeShapeX>(btScalar(0.5), btScalar(0.3)), 0.01)}};
}

std::vector<Solid> hulls() {
  auto scaled = hull_of(random_points(12), 0.01);
  scaled->setLocalScaling(vector(2, 0.5, 1));
  return {{"prism", hull_of(prism(), 0.002)},
          {"hull_40", hull_of(random_points(40), 0.03)},
          {"hull_scaled", scaled}};
}

class SolidDistance : public testing::TestWithParam<Solid> {
 protected:
  [[nodiscard]] SurfaceDistance at(const Vector3<double>& place) {
    const auto found =
        surface_distance(*GetParam().shape, hulls_.find(*GetParam().shape), place, kFar);
    EXPECT_TRUE(found) << "no distance";
    return found.value_or(SurfaceDistance{});
  }
  static std::vector<Vector3<double>> places() {
    std::mt19937 random(11);
    std::uniform_real_distribution<double> at(-1.2, 1.2);
    std::vector<Vector3<double>> all;
    for (int i = 0; i < 4000; ++i) {
      const double x = at(random);
      const double y = at(random);
      all.emplace_back(x, y, at(random));
      if (i % 2 == 0) all.back() *= 0.25;  // inside of most
    }
    return all;
  }

 private:
  HullTable hulls_;
};

class NamedSolidDistance : public SolidDistance {};
class HullDistance : public SolidDistance {};

// Basis of 1e-3 m: GJK ends at a relative 1e-4 of distances up to 2 m; edges of boxes and cylinders are rounded there by their
// margin, 1e-4 m. Not for hulls: of one of 12 points, scaled, GJK stops as much as 7.6 mm before the nearest point.
TEST_P(NamedSolidDistance, AgreesWithBulletsSearchOutside) {
  int num_outside = 0;
  for (const Vector3<double>& place : places()) {
    btGjkEpaSolver2::sResults found{};
    const btScalar bullets =
        btGjkEpaSolver2::SignedDistance(vector(place[0], place[1], place[2]), 0,
                                        GetParam().shape.get(), btTransform::getIdentity(), found);
    if (found.status != btGjkEpaSolver2::sResults::Separated || bullets < btScalar(0.02)) continue;
    ++num_outside;
    const SurfaceDistance ours = at(place);
    ASSERT_NEAR(ours.distance, static_cast<double>(bullets), 1e-3) << place.transpose();
    ASSERT_GT(static_cast<double>(found.normal.dot(vector(ours.out[0], ours.out[1], ours.out[2]))),
              0.99)
        << place.transpose();
  }
  EXPECT_GT(num_outside, 1000);
}

struct Bounds {
  double low, high;  ///< [m]
};

/// Bounds of the distance from a place outside to the hull of points, by Frank and Wolfe with steps away: a point of the hull is
/// no nearer than the nearest, and a plane across the way to it has all points behind.
Bounds distance_bounds(const std::vector<Vector3<double>>& points, const Vector3<double>& place) {
  std::vector<double> weights(points.size(), 0.0);
  weights[0] = 1;
  Bounds bounds{0, 0};
  for (int round = 0; round < 2000; ++round) {
    Vector3<double> foot = Vector3<double>::Zero();
    for (std::size_t i = 0; i < points.size(); ++i) foot += weights[i] * points[i];
    const Vector3<double> way = foot - place;
    std::size_t best = 0;
    std::size_t worst = points.size();
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double at = way.dot(points[i]);
      if (at < way.dot(points[best])) best = i;
      if (weights[i] > 0 && (worst == points.size() || at > way.dot(points[worst]))) worst = i;
    }
    bounds.high = way.norm();
    bounds.low = std::max(bounds.low, way.dot(points[best] - place) / bounds.high);
    if (bounds.high - bounds.low < 1e-7) break;
    // All weight that the step can move goes from the worst point to the best.
    const Vector3<double> step = points[best] - points[worst];
    const double length = std::clamp(-way.dot(step) / step.squaredNorm(), 0.0, weights[worst]);
    weights[best] += length;
    weights[worst] -= length;
  }
  return bounds;
}

TEST_P(HullDistance, LiesBetweenItsBounds) {
  const auto& hull = static_cast<const btConvexHullShape&>(*GetParam().shape);
  std::vector<Vector3<double>> points;
  for (int i = 0; i < hull.getNumPoints(); ++i) {
    const btVector3 point = hull.getScaledPoint(i);
    points.emplace_back(point.x(), point.y(), point.z());
  }
  int num_sharp = 0;
  for (const Vector3<double>& place : places()) {
    const double ours = at(place).distance + static_cast<double>(hull.getMargin());
    if (ours < 0.01) continue;
    const Bounds bounds = distance_bounds(points, place);
    ASSERT_GT(ours, bounds.low - 1e-6) << place.transpose();  // corners are float's
    ASSERT_LT(ours, bounds.high + 1e-6) << place.transpose();
    if (bounds.high - bounds.low < 1e-5) ++num_sharp;
  }
  EXPECT_GT(num_sharp, 1000);
}

// A place goes to the surface along `out`, from outside and, where the nearest facet is not left on the way, from inside.
TEST_P(SolidDistance, LeadsToTheSurface) {
  int num_inside = 0;
  for (const Vector3<double>& place : places()) {
    const SurfaceDistance found = at(place);
    ASSERT_NEAR(found.out.norm(), 1, 1e-12);
    if (found.distance < 0) ++num_inside;
    ASSERT_NEAR(at(place - found.distance * found.out).distance, 0, 1e-9) << place.transpose();
  }
  EXPECT_GT(num_inside, 20);
}

// |d(a) - d(b)| <= |a - b| of any distance: no jumps where the nearest part changes.
TEST_P(SolidDistance, ChangesNoFasterThanThePlace) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> by(-0.01, 0.01);
  for (const Vector3<double>& place : places()) {
    const double x = by(random);
    const double y = by(random);
    const Vector3<double> step(x, y, by(random));
    ASSERT_LE(std::abs(at(place + step).distance - at(place).distance), step.norm() + 1e-9)
        << place.transpose();
  }
}

constexpr auto name_of = [](const auto& solid) { return solid.param.name; };
INSTANTIATE_TEST_SUITE_P(Named, SolidDistance, testing::ValuesIn(named_solids()), name_of);
INSTANTIATE_TEST_SUITE_P(Hulls, SolidDistance, testing::ValuesIn(hulls()), name_of);
INSTANTIATE_TEST_SUITE_P(Solids, NamedSolidDistance, testing::ValuesIn(named_solids()), name_of);
INSTANTIATE_TEST_SUITE_P(Solids, HullDistance, testing::ValuesIn(hulls()), name_of);

TEST(SurfaceDistance, OfAMirroredCapsuleIsThatOfTheCapsule) {
  const btCapsuleShape capsule(btScalar(0.2), btScalar(0.6));
  btCapsuleShape mirrored(btScalar(0.2), btScalar(0.6));
  mirrored.setLocalScaling(vector(-1, -1, -1));
  for (const auto& place : {Vector3<double>(0.5, 0.1, 0), Vector3<double>(0.1, 0.7, 0.1)}) {
    const auto one = surface_distance(capsule, nullptr, place, kFar);
    const auto other = surface_distance(mirrored, nullptr, place, kFar);
    ASSERT_TRUE(one && other);
    EXPECT_EQ(one->distance, other->distance);
    EXPECT_EQ(one->out, other->out);
  }
}

TEST(HullFacets, OfABoxsCornersHaveTheBoxsDistance) {
  std::vector<btVector3> corners;
  for (int c = 0; c < 8; ++c) {
    corners.push_back(vector((c & 1) ? 0.3 : -0.3, (c & 2) ? 0.2 : -0.2, (c & 4) ? 0.5 : -0.5));
  }
  const auto hull = hull_of(corners, 0);
  btBoxShape box(vector(0.3, 0.2, 0.5));
  HullTable hulls;
  std::mt19937 random(5);
  std::uniform_real_distribution<double> at(-1, 1);
  for (int i = 0; i < 2000; ++i) {
    const double x = at(random);
    const double y = at(random);
    const Vector3<double> place(x, y, at(random));
    const auto of_hull = surface_distance(*hull, hulls.find(*hull), place, kFar);
    const auto of_box = surface_distance(box, nullptr, place, kFar);
    ASSERT_TRUE(of_hull && of_box);
    ASSERT_NEAR(of_hull->distance, of_box->distance, 1e-6)
        << place.transpose();  // of float corners
  }
}

TEST(HullFacets, AreNoneForPointsInAPlaneOrTooMany) {
  HullTable hulls;
  const auto flat = hull_of(
      {vector(0, 0, 0), vector(1, 0, 0), vector(0, 1, 0), vector(1, 1, 0), vector(0.3, 0.4, 0)},
      0.01);
  EXPECT_EQ(hulls.find(*flat), nullptr);
  const auto many = hull_of(random_points(HullFacets::kMostPoints + 1), 0.01);
  EXPECT_EQ(hulls.find(*many), nullptr);
  EXPECT_TRUE(needs_distance_field(*many, nullptr));
  EXPECT_EQ(hulls.find(btSphereShape(1)), nullptr);
}

TEST(HullFacets, OutOfReachAreFarther) {
  const auto hull = hull_of(random_points(40), 0.01);
  HullTable hulls;
  for (const double x : {0.6, 0.8, 1.5}) {
    const Vector3<double> place(x, x, 0.9 * x);
    const double whole = surface_distance(*hull, hulls.find(*hull), place, kFar)->distance;
    const double in_reach =
        surface_distance(*hull, hulls.find(*hull), place, whole + 0.01)->distance;
    const double out_of_reach = surface_distance(*hull, hulls.find(*hull), place, 0.1)->distance;
    EXPECT_EQ(in_reach, whole);
    EXPECT_GE(out_of_reach, 0.1);
  }
}

TEST(HullTable, NoticesThatAShapeHasChanged) {
  HullTable hulls;
  const auto hull = hull_of(prism(), 0);
  const Vector3<double> place(0.2, 0.2, 1);
  const double before = surface_distance(*hull, hulls.find(*hull), place, kFar)->distance;
  const HullFacets* const known = hulls.find(*hull);
  EXPECT_EQ(hulls.find(*hull), known);
  hull->setLocalScaling(vector(1, 1, 3));
  EXPECT_LT(surface_distance(*hull, hulls.find(*hull), place, kFar)->distance, before - 0.01);
}

}  // namespace
}  // namespace weft::bridge
