#include <weft/engines/bullet/bullet_shapes.hpp>

#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <BulletSoftBody/btSparseSDF.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <weft/core/error.hpp>
#include <weft/engines/engine_table.hpp>
#include <weft/scenes/shapes/shape_surface.hpp>
#include <weft/validation/metrics/distance/shape_distance.hpp>

namespace weft::scenes {
namespace {

using ::testing::HasSubstr;

ConvexHullShape wedge() {
  ConvexHullShape hull{Matrix3X<double>(3, 6)};
  hull.points << -0.4, 0.4, -0.4, 0.4, -0.4, 0.4,  //
      -0.3, -0.3, -0.3, -0.3, 0.3, 0.3,            //
      -0.4, -0.4, 0.4, 0.4, 0.0, 0.0;
  return hull;
}

std::vector<Shape> convex_shapes() {
  return {SphereShape{0.4},        BoxShape{{0.3, 0.4, 0.5}}, CapsuleShape{0.3, 0.4},
          CylinderShape{0.3, 0.8}, ConeShape{0.4, 0.8},       Shape(wedge())};
}

Scene scene_with(const Collider& collider) {
  Scene scene;
  scene.name = "test";
  Cloth cloth;
  cloth.name = "cloth";
  cloth.grid().nodes = {3, 3};
  cloth.grid().total_mass = 0.1;
  cloth.grid().center = {0, 5, 0};
  scene.cloths = {cloth};
  scene.colliders = {collider};
  return scene;
}

TEST(BulletShapes, ConvexShapesHaveTheExactSurface) {
  // Margins are at most 1 % of the smallest half extent, 0.4 m; single precision costs Bullet's
  // search on curved surfaces up to 1.6 mm.
  constexpr double kTolerance = 0.004 + 0.0016;  // [m]
  // Inside polyhedra Bullet's search now and then ends on a wrong side: seen at 1 of 2000 points.
  constexpr int kMaxOutliers = 4;
  std::mt19937 random(7);
  std::uniform_real_distribution<double> coordinate(-0.7, 0.7);
  for (const Shape& shape : convex_shapes()) {
    int num_outliers = 0;
    const auto made = make_bullet_shape(shape, ConcaveContact::kPrisms);
    const validation::ShapeDistance exact(shape);
    for (int i = 0; i < 2000; ++i) {
      const Vector3<double> x(coordinate(random), coordinate(random), coordinate(random));
      if (std::abs(exact(x)) > 0.15) continue;
      const btVector3 point(static_cast<btScalar>(x.x()), static_cast<btScalar>(x.y()),
                            static_cast<btScalar>(x.z()));
      const auto measured = static_cast<double>(btSparseSdf<3>::DistanceToShape(point, made.get()));
      if (!(std::abs(measured - exact(x)) <= kTolerance)) ++num_outliers;
    }
    EXPECT_LE(num_outliers, kMaxOutliers) << "shape " << shape.index();
  }
}

TEST(BulletShapes, PrismsAreFlushWithTheirMeshAndSolidBehindIt) {
  const MeshShape ball = shape_surface(SphereShape{0.5}, 16);
  const auto made = make_bullet_shape(ball, ConcaveContact::kPrisms);
  const auto* compound = dynamic_cast<const btCompoundShape*>(made.get());
  ASSERT_NE(compound, nullptr);
  ASSERT_EQ(compound->getNumChildShapes(), ball.triangles.cols());
  const auto distance = [&](const Vector3<double>& x) {
    double nearest = 1e9;
    const btVector3 point(static_cast<btScalar>(x.x()), static_cast<btScalar>(x.y()),
                          static_cast<btScalar>(x.z()));
    for (int i = 0; i < compound->getNumChildShapes(); ++i) {
      nearest = std::min(nearest, static_cast<double>(btSparseSdf<3>::DistanceToShape(
                                      point, compound->getChildShape(i))));
    }
    return nearest;
  };
  const validation::ShapeDistance exact(ball);
  for (int i = 1; i <= 200; ++i) {
    const Vector3<double> way =
        Vector3<double>(std::sin(12.9 * i), std::sin(78.2 * i), std::sin(37.7 * i)).normalized();
    EXPECT_NEAR(distance(0.55 * way), exact(0.55 * way), 0.002);
    // A quarter of the extent of 1 m deep: at 0.35 m from the middle all is solid.
    EXPECT_LT(distance(0.35 * way), 0.002);
  }
}

TEST(BulletShapes, ABodyStandsWhereTheSceneSaysAndTurnsAboutItsCentreOfMass) {
  Collider cone{.name = "cone", .shape = ConeShape{0.3, 0.8}, .position = {1, 2, 3}};
  cone.orientation = Eigen::AngleAxisd(0.5, Vector3<double>(1, 2, 0).normalized());
  cone.mass = 2.0;
  EXPECT_NEAR(bullet_shape_offset(cone).y(), -0.2, 1e-3);  // a quarter of the height over the base
  const auto engine =
      find_engine("bullet_soft", bullet_description().find("double") != std::string::npos
                                     ? StoredPrecision::kFloat64
                                     : StoredPrecision::kFloat32)
          ->make();
  engine->load(scene_with(cone));
  const double rounding = 1e-6;  // [m] of single precision at 3 m
  EXPECT_LT((engine->state().rigids[0].position - cone.position).norm(), rounding);
  const BulletCollider made = make_bullet_collider(cone);
  const Vector3<double> inertia = 2.0 * solid_moments(cone.shape).inertia;
  EXPECT_NEAR(static_cast<double>(made.body->getLocalInertia().x()), inertia.x(), 1e-6);
  EXPECT_NEAR(static_cast<double>(made.body->getLocalInertia().y()), inertia.y(), 1e-6);
}

/// A plate of 12 triangles, 4 m wide and 20 cm thick; its upper side at y = 0.
MeshShape wide_plate() {
  MeshShape plate{Matrix3X<double>(3, 8), Triangles(3, 12)};
  plate.points << -2, 2, 2, -2, -2, 2, 2, -2,  //
      -0.2, -0.2, -0.2, -0.2, 0, 0, 0, 0,      //
      -2, -2, 2, 2, -2, -2, 2, 2;
  plate.triangles << 0, 0, 4, 4, 0, 0, 1, 1, 2, 2, 3, 3,  //
      1, 2, 6, 7, 5, 4, 6, 5, 7, 6, 4, 7,                 //
      2, 3, 5, 6, 1, 5, 2, 6, 3, 7, 0, 4;
  return plate;
}

constexpr StoredPrecision kPrecision =
    sizeof(btScalar) == sizeof(double) ? StoredPrecision::kFloat64 : StoredPrecision::kFloat32;

// A distance field with voxels for the plate's edges has no value worth the name between them: Bullet's own contact lets
// all of the cloth fall through.
TEST(BulletShapes, AClothLiesOnWideTriangles) {
  Collider collider;
  collider.name = "plate";
  collider.shape = wide_plate();
  Scene scene = scene_with(collider);
  Cloth& cloth = scene.cloths[0];
  cloth.grid().nodes = {7, 7};
  cloth.grid().size = {0.6, 0.6};
  cloth.grid().center = {0.3, 0.3, 0.2};
  cloth.collision_margin = 0.02;
  cloth.laws = {{"gravity", {}, {{"acceleration", {0.0, -9.81, 0.0}}}},
                {"tension", {}, {{"stiffness", {10.0}}}},
                {"velocity_damping", {}, {{"rate", {1.0}}}}};
  scene.world.time_step = 1.0 / 1000;
  scene.world.gravity = {0, -9.81, 0};
  for (const char* engine : {"bullet_forces", "bullet_weft"}) {
    const auto simulator = find_engine(engine, kPrecision)->make();
    simulator->load(scene);
    for (int i = 0; i < 600; ++i) (void)simulator->step(scene.world.time_step);
    const auto heights = simulator->state().cloths[0].positions.row(1);
    EXPECT_GT(heights.minCoeff(), 0.0) << engine;
    EXPECT_LT(heights.maxCoeff(), 0.04) << engine;
  }
}

TEST(BulletShapes, TheReferenceRefusesWhatItDoesNotKnowByName) {
  const auto engine = find_engine("reference", StoredPrecision::kFloat64)->make();
  try {
    engine->load(scene_with({.name = "pair", .shape = CompoundShape{{{SphereShape{0.1}}}}}));
    FAIL() << "loaded";
  } catch (const InvalidArgument& error) {
    EXPECT_THAT(error.what(), HasSubstr("collider 'pair': shape = \"compound\""));
    EXPECT_THAT(error.what(), HasSubstr("bullet_soft"));
  }
  MeshShape open = shape_surface(BoxShape{{0.1, 0.2, 0.3}});
  open.triangles.conservativeResize(3, open.triangles.cols() - 1);
  try {
    engine->load(scene_with({.name = "tray", .shape = open}));
    FAIL() << "loaded";
  } catch (const InvalidArgument& error) {
    EXPECT_THAT(error.what(), HasSubstr("collider 'tray'"));
    EXPECT_THAT(error.what(), HasSubstr("expected a closed surface"));
  }
}

TEST(BulletShapes, TheReferenceTakesRoundShapesClosedMeshesAndSelfCollision) {
  const auto engine = find_engine("reference", StoredPrecision::kFloat64)->make();
  Matrix3X<double> corners(3, 4);
  corners << 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1;
  for (const Shape& shape :
       {Shape(CapsuleShape{0.1, 0.2}), Shape(CylinderShape{0.1, 0.2}), Shape(ConeShape{0.1, 0.2}),
        Shape(ConvexHullShape{corners}), Shape(shape_surface(BoxShape{{0.1, 0.2, 0.3}}))}) {
    Scene scene = scene_with({.name = "shape", .shape = shape});
    scene.cloths[0].self_collision = true;
    scene.reference.contact_points = ContactPoints::kNodesAndFaces;
    engine->load(scene);
    EXPECT_FALSE(engine->step(1e-3).blow_up) << shape.index();
  }
}

}  // namespace
}  // namespace weft::scenes
