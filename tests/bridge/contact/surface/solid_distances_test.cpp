// Distances of groups of nodes against surface_distance() for one node after the other.
#include <cmath>
#include <memory>
#include <random>

#include <gtest/gtest.h>

#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/CollisionShapes/btCapsuleShape.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>

#include <weft/bridge/contact/surface/solid_distances.hpp>

#include "tests/bridge/rigid_objects.hpp"

namespace weft::bridge {
namespace {

bool is_same(double one, double other) {
  return one == other && std::signbit(one) == std::signbit(other);
}

bool is_same(const Vector3<double>& one, const Vector3<double>& other) {
  return is_same(one[0], other[0]) && is_same(one[1], other[1]) && is_same(one[2], other[2]);
}

/// How many of some positions about a shape have a distance with other bits than surface_distance() gives. grid: positions are
/// multiples of it, many of which are as near to two faces or in a plane of symmetry; 0: anywhere [m].
int num_different(const btCollisionShape& shape, const btTransform& pose, double grid) {
  btCollisionObject object;
  Collider collider{&object, &shape, pose, nullptr};
  Matrix3<double> turn;
  for (int k = 0; k < 3; ++k) turn.row(k) = from_bullet(pose.getBasis().getRow(k));
  const Vector3<double> origin = from_bullet(pose.getOrigin());
  const SolidDistances solid(collider);
  std::mt19937 random(11);
  std::uniform_real_distribution<double> at(-1, 1);
  int count = 0;
  for (int batch = 0; batch < 500; ++batch) {
    SolidDistances::Vectors positions;
    for (int lane = 0; lane < SolidDistances::kLanes; ++lane) {
      for (std::size_t k = 0; k < 3; ++k) {
        const double place = at(random);
        const double kept = grid > 0 ? grid * std::round(place / grid) : place;
        positions[k][lane] = static_cast<double>(static_cast<btScalar>(kept) +
                                                 pose.getOrigin()[static_cast<int>(k)]);
      }
    }
    const SolidDistances::Distances found = solid.of(positions);
    for (int lane = 0; lane < SolidDistances::kLanes; ++lane) {
      const Vector3<double> position(positions[0][lane], positions[1][lane], positions[2][lane]);
      const Vector3<double> point = turn.transpose() * (position - origin);
      const SurfaceDistance one = surface_distance(shape, nullptr, point, 1.0).value();
      const bool are_same = is_same(found.point(lane), point) &&
                            is_same(found.surface(lane).out, one.out) &&
                            is_same(found.surface(lane).distance, one.distance);
      count += are_same ? 0 : 1;
    }
  }
  return count;
}

// Boxes of which most positions are beside a face, an edge, a corner, and inside. To the bit, however the collider is turned.
TEST(SolidDistances, AreThoseOfOneNodeAfterTheOther) {
  const btBoxShape box(vector(0.6, 0.3, 0.7));
  const btBoxShape cube(vector(0.5, 0.5, 0.5));
  const btSphereShape ball(btScalar(0.6));
  const btQuaternion none = btQuaternion::getIdentity();
  const btQuaternion quarter(vector(0, 0, 1), SIMD_HALF_PI);
  const btQuaternion turned(vector(1, 2, -0.5).normalized(), btScalar(0.8));
  for (const btQuaternion& turn : {none, quarter, turned}) {
    for (const btVector3& origin : {vector(0, 0, 0), vector(0.3, -0.7, 2.1)}) {
      for (const double grid : {0.0, 0.25}) {
        const btTransform pose(turn, origin);
        EXPECT_EQ(num_different(box, pose, grid), 0);
        EXPECT_EQ(num_different(cube, pose, grid), 0);
        EXPECT_EQ(num_different(ball, pose, grid), 0);
      }
    }
  }
}

TEST(SolidDistances, AreOfBoxesAndBallsOnly) {
  EXPECT_TRUE(SolidDistances::has(btBoxShape(vector(1, 1, 1))));
  EXPECT_TRUE(SolidDistances::has(btSphereShape(1)));
  EXPECT_FALSE(SolidDistances::has(btCapsuleShape(1, 1)));
}

}  // namespace
}  // namespace weft::bridge
