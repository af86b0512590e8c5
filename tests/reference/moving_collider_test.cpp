#include <cmath>

#include <gtest/gtest.h>

#include <weft/reference/balance.hpp>

#include "tests/reference/small_systems.hpp"

namespace weft::reference::testing {
namespace {

using Vec = Vector3<double>;

constexpr double kGravity = 9.81;  // [m/s^2]
constexpr double kMargin = 0.02;   // [m]

Eigen::Quaterniond some_rotation() {
  return Eigen::Quaterniond(Eigen::AngleAxisd(0.7, Vec(1, -2, 3).normalized()));
}

System collision_in_free_space(const Shape& shape) {
  Body cloth = make_cloth(9, 1.0, 0.5, 0.0, 80.0, 0.05);
  cloth.collision_margin = kMargin;
  cloth.friction = 0.6;
  System system = system_of(std::move(cloth));
  Collider ball{.name = "projectile", .shape = shape, .position = {0.11, 0.3, -0.07}};
  ball.orientation = some_rotation();
  ball.mass = 0.4;
  ball.velocity = {0.5, -3.0, 0.2};
  ball.angular_velocity = {4, -6, 9};
  system.colliders.push_back(ball);
  return system;
}

TEST(DynamicCollider, ClothInFreeSpaceConservesMomenta) {
  for (const Shape& shape : {Shape(Sphere{0.2}), Shape(Box{{0.2, 0.12, 0.15}})}) {
    for (const IntegratorKind integrator : kAllIntegrators) {
      // Modified Euler and Verlet conserve angular momentum under central forces; the two others
      // only to their order, and their contact alone is looked at in the next test.
      const bool conserves_spin = integrator == IntegratorKind::kModifiedEuler ||
                                  integrator == IntegratorKind::kVelocityVerlet;
      SpringSolver solver(collision_in_free_space(shape), {.integrator = integrator});
      const Vec linear = linear_momentum(solver.system());
      const Vec angular = angular_momentum(solver.system());
      int num_contacts = 0;
      for (int n = 0; n < 300; ++n) {
        const StepOutcome outcome = solver.step(0.001);
        ASSERT_TRUE(outcome.contact.converged) << name_of(integrator) << " step " << n;
        num_contacts = std::max(num_contacts, outcome.contact.num_contacts);
      }
      EXPECT_GT(num_contacts, 3) << name_of(integrator);
      // Round-off: 300 steps of some hundred sums of size 1.
      constexpr double kRoundOff = 1e-12;
      EXPECT_LT((linear_momentum(solver.system()) - linear).norm(), kRoundOff)
          << name_of(integrator);
      if (conserves_spin) {
        EXPECT_LT((angular_momentum(solver.system()) - angular).norm(), kRoundOff)
            << name_of(integrator);
      }
      EXPECT_GT((solver.system().colliders[0].velocity - Vec(0.5, -3, 0.2)).norm(), 0.1);
    }
  }
}

TEST(DynamicCollider, ASingleImpactConservesAngularMomentumForEveryIntegrator) {
  // One free node, no other force: all that acts is the contact itself.
  for (const Shape& shape : {Shape(Sphere{0.2}), Shape(Box{{0.2, 0.12, 0.15}})}) {
    for (const IntegratorKind integrator : kAllIntegrators) {
      System system = collision_in_free_space(shape);
      system.bodies[0] = make_free_node(0.1, {0.05, -0.1, 0.02}, Vec::Zero());
      system.bodies[0].collision_margin = kMargin;
      system.bodies[0].friction = 0.6;
      SpringSolver solver(std::move(system), {.integrator = integrator});
      const Vec linear = linear_momentum(solver.system());
      const Vec angular = angular_momentum(solver.system());
      int num_contacts = 0;
      for (int n = 0; n < 300; ++n) num_contacts += solver.step(0.001).contact.num_contacts;
      EXPECT_GT(num_contacts, 0);
      constexpr double kRoundOff = 1e-13;  // 300 steps of sums of size 1
      EXPECT_LT((linear_momentum(solver.system()) - linear).norm(), kRoundOff);
      EXPECT_LT((angular_momentum(solver.system()) - angular).norm(), kRoundOff)
          << name_of(integrator);
    }
  }
}

TEST(DynamicCollider, ABallStopsOnAPinnedClothWithoutGainingEnergy) {
  Body cloth = make_cloth(11, 1.0, 0.3, 0.0, 200.0, 0.2);
  cloth.mesh.pinned = {0, 10, 110, 120};
  add_law(cloth, "gravity", {{"acceleration", {0, -kGravity, 0}}});
  add_law(cloth, "velocity_damping", {{"rate", {8.0}}});
  cloth.collision_margin = kMargin;
  cloth.friction = 0.5;
  System system = system_of(std::move(cloth));
  system.gravity = {0, -kGravity, 0};
  Collider ball{.name = "ball", .shape = Sphere{0.2}, .position = {0.02, 0.4, 0.01}};
  ball.mass = 0.5;
  system.colliders.push_back(ball);
  SpringSolver solver(std::move(system));
  const double start = energies(solver.system()).total();
  double highest = start;
  StepOutcome last;
  constexpr double kStep = 5e-4;  // [s]
  for (int n = 0; n < 18000; ++n) {
    last = solver.step(kStep);
    ASSERT_TRUE(last.is_step_stable) << last.stable_step;
    ASSERT_TRUE(last.contact.converged) << n;
    ASSERT_FALSE(last.blow_up);
    highest = std::max(highest, energies(solver.system()).total());
  }
  // Modified Euler's own energy swings by its first order: 2 J of fall times h w / 2, a few
  // percent.
  EXPECT_LT(highest, start + 0.1);
  const Collider& rest = solver.system().colliders[0];
  EXPECT_LT(rest.velocity.norm(), 0.01);
  EXPECT_LT((rest.position - Vec(0, -0.2, 0)).norm(), 0.6);  // in the cloth, not through it
  EXPECT_GE(last.contact.normal_impulse / kStep, 0.99 * 0.5 * kGravity);
}

TEST(DynamicCollider, ASpinningBoxKeepsAngularMomentumAndTumblesTheSameInAnyStep) {
  const auto end_orientation = [](int steps) {
    System system;
    Collider box{.name = "box", .shape = Box{{0.3, 0.1, 0.2}}};
    box.mass = 2.0;
    box.angular_velocity = {3, 0.1, 0.2};
    system.colliders.push_back(box);
    SpringSolver solver(std::move(system), {.integrator = IntegratorKind::kVelocityVerlet});
    const Vec spin = angular_momentum(solver.system());
    for (int n = 0; n < steps; ++n) (void)solver.step(1.0 / steps);
    EXPECT_LT((angular_momentum(solver.system()) - spin).norm(), steps * kEpsilon);  // round-off
    return solver.system().colliders[0].orientation;
  };
  const Eigen::Quaterniond solution = end_orientation(20000);
  // Substeps of 0.05 rad and order 6: what is left is the round-off of 20,000 steps.
  for (const int steps : {1, 10, 100, 200}) {
    EXPECT_LT(end_orientation(steps).angularDistance(solution), 1e-10) << steps;
  }
}

TEST(KinematicCollider, AMovingPlaneCarriesAStickingNode) {
  System system = system_of(make_free_node(0.2, {0, kMargin, 0}, {0, -kGravity, 0}));
  system.bodies[0].collision_margin = kMargin;
  system.bodies[0].friction = 1.0;
  Collider belt{.name = "belt", .shape = Plane{}, .velocity = {0.03, 0, 0}};
  system.colliders.push_back(belt);
  SpringSolver solver(std::move(system));
  for (int n = 0; n < 100; ++n) (void)solver.step(0.01);
  EXPECT_NEAR(solver.system().bodies[0].velocities(0, 0), 0.03, 8 * kEpsilon);
  EXPECT_NEAR(solver.system().bodies[0].positions(0, 0), 0.03, 1e-12);  // round-off of 100 sums
}

}  // namespace
}  // namespace weft::reference::testing
