#include <weft/recorder/placed_shape.hpp>

#include <memory>
#include <string>
#include <variant>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <weft/core/error.hpp>
#include <weft/recorder/recorder.hpp>
#include <weft/scenes/recording/recording.hpp>
#include <weft/scenes/shapes/shape_surface.hpp>

#include "tests/recorder/small_world.hpp"
#include "tests/scenes/recording/recording_samples.hpp"

namespace weft::recorder {
namespace {

using scenes::samples::TemporaryFolder;
using testing::HasSubstr;
using testing::ThrowsMessage;

/// What is read back of one body with this shape: the points of the picture in the world [m].
Matrix3X<double> drawn_points(std::unique_ptr<btCollisionShape> shape, const btTransform& place) {
  const TemporaryFolder folder;
  {
    SmallWorld world;
    const btSoftBody& cloth = world.add_patch(3, 50.0);
    const btRigidBody& body = world.add(std::move(shape), 1.0, place);
    Recorder recorder(folder / "shape.weftrec");
    recorder.add(cloth, "cape");
    recorder.add(body, "body");
    EXPECT_TRUE(recorder.record(0));
  }
  const scenes::RecordingReader reader(folder / "shape.weftrec");
  const scenes::RigidState body = reader.frame(0).rigids[0];
  // Round shapes are polyhedra; with so many sides they are within 1e-4 of their radius.
  Matrix3X<double> points = scenes::shape_surface(reader.scene().colliders[0].shape, 192).points;
  for (auto point : points.colwise()) {
    point = (body.position + body.orientation * Vector3<double>(point)).eval();
  }
  return points;
}

const btTransform kPlace =
    at(1, 2, -3, btQuaternion(btVector3(1, 2, 3).normalized(), btScalar(0.7)));

/// Bullet's shape and the drawn one reach equally far in every direction. margin: how much farther
/// Bullet's reaches [m].
void expect_same_extent(std::unique_ptr<btConvexShape> shape, double margin = 0.0) {
  std::vector<std::pair<Vector3<double>, double>> reach;
  for (int i = 0; i < 40; ++i) {
    const Vector3<double> direction =
        Vector3<double>(std::sin(1.0 + 3 * i), std::cos(2.0 * i), std::sin(5.0 * i)).normalized();
    const btVector3 towards(static_cast<btScalar>(direction[0]),
                            static_cast<btScalar>(direction[1]),
                            static_cast<btScalar>(direction[2]));
    const btVector3 local = towards * kPlace.getBasis();
    const btVector3 point = kPlace * shape->localGetSupportingVertex(local);
    reach.emplace_back(direction, static_cast<double>(point.dot(towards)) - margin);
  }
  const std::string name = shape->getName();
  const Matrix3X<double> points = drawn_points(std::move(shape), kPlace);
  constexpr double kPolyhedron = 2e-3;  // [m]
  for (const auto& [direction, distance] : reach) {
    EXPECT_NEAR((direction.transpose() * points).maxCoeff(), distance, kPolyhedron) << name;
  }
}

/// Without the margin that rounds the edges of Bullet's cylinders and lets its cones grow.
template <class Shape>
std::unique_ptr<btConvexShape> sharp(const Shape& shape) {
  auto copy = std::make_unique<Shape>(shape);
  copy->setMargin(0);
  return copy;
}

TEST(PlacedShape, IsDrawnWhereBulletHasIt) {
  const auto s = [](double value) { return static_cast<btScalar>(value); };
  expect_same_extent(std::make_unique<btSphereShape>(s(0.5)));
  expect_same_extent(std::make_unique<btBoxShape>(btVector3(s(0.3), s(0.5), s(0.8))));
  expect_same_extent(std::make_unique<btCapsuleShape>(s(0.3), s(0.9)));
  expect_same_extent(std::make_unique<btCapsuleShapeX>(s(0.3), s(0.9)));
  expect_same_extent(std::make_unique<btCapsuleShapeZ>(s(0.3), s(0.9)));
  expect_same_extent(sharp(btCylinderShape(btVector3(s(0.4), s(0.7), s(0.4)))));
  expect_same_extent(sharp(btCylinderShapeX(btVector3(s(0.7), s(0.4), s(0.4)))));
  expect_same_extent(sharp(btCylinderShapeZ(btVector3(s(0.4), s(0.4), s(0.7)))));
  expect_same_extent(sharp(btConeShape(s(0.4), s(0.9))));
  expect_same_extent(sharp(btConeShapeX(s(0.4), s(0.9))));
  expect_same_extent(sharp(btConeShapeZ(s(0.4), s(0.9))));
  auto hull = std::make_unique<btConvexHullShape>();
  for (const btVector3& point : {btVector3(0, 0, 0), btVector3(1, 0, 0), btVector3(0, 1, 0),
                                 btVector3(0, 0, 1), btVector3(1, 1, 1)}) {
    hull->addPoint(point);
  }
  hull->setLocalScaling(btVector3(s(0.5), 1, s(1.5)));
  const auto margin = static_cast<double>(hull->getMargin());
  ASSERT_GT(margin, 0);
  expect_same_extent(std::move(hull), margin);
}

TEST(PlacedShape, CompoundHasItsPartsInPlace) {
  static btSphereShape sphere(btScalar(0.25));
  static btCapsuleShapeX capsule(btScalar(0.2), 1);
  static btCompoundShape inner;
  inner.addChildShape(at(0, 1, 0), &sphere);
  auto outer = std::make_unique<btCompoundShape>();
  outer->addChildShape(at(0, 0, 0, btQuaternion(btVector3(0, 0, 1), SIMD_HALF_PI)), &capsule);
  outer->addChildShape(at(2, 0, 0), &inner);
  const Matrix3X<double> points = drawn_points(std::move(outer), at(0, 0, 10));
  const Vector3<double> low = points.rowwise().minCoeff();
  const Vector3<double> high = points.rowwise().maxCoeff();
  // The capsule stands upright, the sphere is at (2, 1, 10).
  EXPECT_LT((low - Vector3<double>(-0.2, -0.7, 9.75)).norm(), 1e-3);
  EXPECT_LT((high - Vector3<double>(2.25, 1.25, 10.25)).norm(), 1e-3);
}

TEST(PlacedShape, PlaneHasItsNormalAlongY) {
  const btVector3 normal = btVector3(1, 2, 2) / 3;
  const btStaticPlaneShape plane(normal, btScalar(0.6));
  const PlacedShape placed = placed_shape(plane, "plane");
  ASSERT_TRUE(std::holds_alternative<scenes::PlaneShape>(placed.shape));
  const Vector3<double> n = Vector3<double>(1, 2, 2) / 3;
  EXPECT_LT((placed.orientation * Vector3<double>::UnitY() - n).norm(), 1e-6);
  EXPECT_NEAR(placed.position.dot(n), 0.6, 1e-6);
}

TEST(PlacedShape, RefusesOtherShapes) {
  const btEmptyShape empty;
  EXPECT_THAT([&] { (void)placed_shape(empty, "recorder: 'ghost'"); },
              ThrowsMessage<InvalidArgument>(
                  HasSubstr("recorder: 'ghost': its shape is a Empty, expected a sphere, box")));
  btCompoundShape compound;
  btStaticPlaneShape plane(btVector3(0, 1, 0), 0);
  compound.addChildShape(at(0, 0, 0), &plane);
  EXPECT_THAT([&] { (void)placed_shape(compound, "level"); },
              ThrowsMessage<InvalidArgument>(
                  HasSubstr("level: part 0 of its compound is a STATICPLANE, expected")));
}

TEST(PlacedShape, RefusesAHullWithTooManyPoints) {
  const TemporaryFolder folder;
  SmallWorld world;
  auto hull = std::make_unique<btConvexHullShape>();
  for (int i = 0; i < 129; ++i) {
    const auto angle = static_cast<btScalar>(0.1 * i);
    hull->addPoint(btVector3(std::cos(angle), std::sin(angle), static_cast<btScalar>(i)), false);
  }
  hull->recalcLocalAabb();
  const btRigidBody& body = world.add(std::move(hull), 1, at(0, 0, 0));
  Recorder recorder(folder / "hull.weftrec");
  EXPECT_THAT([&] { recorder.add(body, "rock"); },
              ThrowsMessage<InvalidArgument>(HasSubstr("has 129 points, expected 4 to 128")));
}

}  // namespace
}  // namespace weft::recorder
