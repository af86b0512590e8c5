#include <cmath>

#include <gtest/gtest.h>

#include <weft/reference/balance.hpp>
#include <weft/reference/contact/distance/signed_distance.hpp>

#include "tests/reference/small_systems.hpp"

namespace weft::reference::testing {
namespace {

using Vec = Vector3<double>;
constexpr double kMargin = 0.02;  // [m]

/// A square cloth of 1.6 m with cells of 0.8 m falls over a collider of 0.3 m, between its nodes.
System coarse_cloth(const Shape& shape, bool face_contact) {
  Body cloth = make_cloth(3, 1.6, 0.3, 0.9, 200.0, 0.5);
  add_law(cloth, "gravity", {{"acceleration", {0, -9.81, 0}}});
  add_law(cloth, "velocity_damping", {{"rate", {1.0}}});
  cloth.collision_margin = kMargin;
  cloth.friction = 0.5;
  cloth.face_contact = face_contact;
  System system = system_of(std::move(cloth));
  system.colliders.push_back({.name = "shape", .shape = shape, .position = {0.25, 0, -0.2}});
  return system;
}

/// Least distance of a dense set of places on the triangles from the collider.
double least_distance(const System& system) {
  constexpr int kParts = 20;
  const Collider& collider = system.colliders[0];
  const Body& cloth = system.bodies[0];
  double least = 1e300;
  for (Eigen::Index t = 0; t < cloth.mesh.triangles.cols(); ++t) {
    for (int i = 0; i <= kParts; ++i) {
      for (int j = 0; j + i <= kParts; ++j) {
        const Vec weights(1.0 - (i + j) / double(kParts), i / double(kParts), j / double(kParts));
        Vec place = Vec::Zero();
        for (int k = 0; k < 3; ++k) {
          place += weights[k] * cloth.positions.col(cloth.mesh.triangles(k, t));
        }
        least = std::min(
            least, signed_distance(collider.shape, {collider.position, collider.orientation}, place)
                       .distance);
      }
    }
  }
  return least;
}

const Shape kShapes[] = {Sphere{0.3}, Box{{0.2, 0.3, 0.25}}, Capsule{0.2, 0.3}, Cylinder{0.25, 0.5},
                         Cone{0.25, 0.6}};

TEST(FaceContact, ACoarseClothDoesNotSinkIntoAnyShape) {
  for (const Shape& shape : kShapes) {
    for (const IntegratorKind integrator :
         {IntegratorKind::kModifiedEuler, IntegratorKind::kVelocityVerlet}) {
      SpringSolver solver(coarse_cloth(shape, true), {.integrator = integrator});
      double least = 1e300;
      for (int n = 0; n < 500; ++n) {
        ASSERT_FALSE(solver.step(2e-3).blow_up);
        least = std::min(least, least_distance(solver.system()));
      }
      // What deepest_point() leaves of a triangle of 0.8 m at a sharp edge, a tenth of the margin.
      EXPECT_GT(least, 0.9 * kMargin) << shape.index() << " " << name_of(integrator);
      EXPECT_LT(least, 1.1 * kMargin) << "it must touch";
    }
  }
}

TEST(FaceContact, WithoutItTheSameClothSinksIn) {
  SpringSolver solver(coarse_cloth(Sphere{0.3}, false));
  double least = 1e300;
  for (int n = 0; n < 500; ++n) {
    (void)solver.step(2e-3);
    least = std::min(least, least_distance(solver.system()));
  }
  EXPECT_LT(least, -0.05);
}

TEST(FaceContact, ConservesMomentumWithADynamicBody) {
  System system = coarse_cloth(Box{{0.2, 0.3, 0.25}}, true);
  system.bodies[0].laws = {};
  add_law(system.bodies[0], "tension", {{"stiffness", {200.0}}});
  system.bodies[0].velocities.colwise() = Vec(0, -1.5, 0);
  system.colliders[0].mass = 0.7;
  system.colliders[0].angular_velocity = {0.4, 0.3, -0.2};
  SpringSolver solver(std::move(system));
  const Vec linear = linear_momentum(solver.system());
  const Vec angular = angular_momentum(solver.system());
  int contacts = 0;
  for (int n = 0; n < 600; ++n) contacts += solver.step(1e-3).contact.num_contacts;
  EXPECT_GT(contacts, 0);
  EXPECT_LT((linear_momentum(solver.system()) - linear).norm(), 1e-12 * linear.norm());
  EXPECT_LT((angular_momentum(solver.system()) - angular).norm(), 1e-12 * linear.norm());
}

}  // namespace
}  // namespace weft::reference::testing
