// Planes of groups of nodes against surface_distance() for one node after the other.
#include <cmath>
#include <memory>
#include <random>

#include <gtest/gtest.h>

#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/CollisionShapes/btCapsuleShape.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>

#include <weft/bridge/contact/solid_planes.hpp>

#include "tests/bridge/rigid_objects.hpp"

namespace weft::bridge {
namespace {

constexpr double kMargin = 0.01;  ///< [m]

/// The plane of one node, by the formulas that hold for any shape.
struct OnePlane {
  btVector3 normal;
  double offset;
  double distance;
};

OnePlane plane_of(const Collider& collider, const Vector3<double>& position) {
  Matrix3<double> turn;
  for (int k = 0; k < 3; ++k) turn.row(k) = from_bullet(collider.pose.getBasis().getRow(k));
  const Vector3<double> origin = from_bullet(collider.pose.getOrigin());
  const Vector3<double> local = turn.transpose() * (position - origin);
  const SurfaceDistance surface = surface_distance(*collider.shape, nullptr, local, 1.0).value();
  OnePlane plane;
  plane.normal = to_bullet((turn * surface.out).eval());
  plane.distance = surface.distance;
  plane.offset = from_bullet(plane.normal).dot(turn * local + origin) - surface.distance +
                 static_cast<double>(static_cast<btScalar>(kMargin));
  return plane;
}

/// How many of some random positions about a shape have another plane, and where the most they differ [m].
double largest_difference(const btCollisionShape& shape, const btQuaternion& turn) {
  btCollisionObject object;
  Collider collider{&object, &shape, btTransform(turn, vector(0.3, -0.7, 2.1)), nullptr};
  const SolidPlanes solid(collider, static_cast<btScalar>(kMargin));
  std::mt19937 random(11);
  std::uniform_real_distribution<double> at(-1, 1);
  double most = 0;
  for (int batch = 0; batch < 100; ++batch) {
    SolidPlanes::Vectors positions;
    for (int lane = 0; lane < SolidPlanes::kLanes; ++lane) {
      for (std::size_t k = 0; k < 3; ++k) {
        const double rounded = static_cast<double>(static_cast<btScalar>(at(random)));
        positions[k][lane] =
            rounded + static_cast<double>(collider.pose.getOrigin()[static_cast<int>(k)]);
      }
    }
    const SolidPlanes::Planes planes = solid.at(positions);
    for (int lane = 0; lane < SolidPlanes::kLanes; ++lane) {
      const OnePlane one =
          plane_of(collider, {positions[0][lane], positions[1][lane], positions[2][lane]});
      most = std::max({most, std::abs(planes.offset[lane] - one.offset),
                       std::abs(planes.distance[lane] - one.distance)});
      for (std::size_t k = 0; k < 3; ++k) {
        most = std::max(most, static_cast<double>(std::abs(planes.normal[k][lane] -
                                                           one.normal[static_cast<int>(k)])));
      }
    }
  }
  return most;
}

// Boxes of which most positions are beside a face, an edge, a corner, and inside.
TEST(SolidPlanes, AreThoseOfOneNodeAfterTheOther) {
  const btQuaternion none = btQuaternion::getIdentity();
  const btQuaternion turned(vector(1, 2, -0.5).normalized(), btScalar(0.8));
  EXPECT_EQ(largest_difference(btBoxShape(vector(0.6, 0.3, 0.7)), none), 0);
  EXPECT_EQ(largest_difference(btSphereShape(btScalar(0.6)), none), 0);
  // Sums of three terms in another order: roundings of double precision, and one of a normal's.
  constexpr double kRounding = std::numeric_limits<btScalar>::epsilon() * 2;
  EXPECT_LE(largest_difference(btBoxShape(vector(0.6, 0.3, 0.7)), turned), kRounding);
  EXPECT_LE(largest_difference(btSphereShape(btScalar(0.6)), turned), kRounding);
}

TEST(SolidPlanes, AreOfBoxesAndBallsOnly) {
  EXPECT_TRUE(SolidPlanes::has(btBoxShape(vector(1, 1, 1))));
  EXPECT_TRUE(SolidPlanes::has(btSphereShape(1)));
  EXPECT_FALSE(SolidPlanes::has(btCapsuleShape(1, 1)));
}

}  // namespace
}  // namespace weft::bridge
