#include <cmath>

#include <gtest/gtest.h>

#include "tests/reference/small_systems.hpp"

namespace weft::reference::testing {
namespace {

using Vec = Vector3<double>;

constexpr double kGravity = 9.81;  // [m/s^2]
constexpr double kMargin = 0.02;   // [m]

System incline(double slope, double friction) {
  System system = system_of(make_free_node(0.2, Vec::Zero(), {0, -kGravity, 0}));
  Collider plane{.name = "incline", .shape = Plane{}};
  plane.orientation = Eigen::AngleAxisd(slope, Vec::UnitZ());  // falls towards -x
  plane.friction = 0.5;
  Body& node = system.bodies[0];
  node.friction = friction / plane.friction;
  node.collision_margin = kMargin;
  node.positions = kMargin * (plane.orientation * Vec::UnitY());
  system.colliders.push_back(plane);
  return system;
}

TEST(Incline, SticksWithoutCreepBelowTheAngleOfFriction) {
  constexpr double kStep = 0.005;   // [s]
  constexpr double kCreep = 1e-12;  // [m/s], round-off of g h
  for (const IntegratorKind integrator : kAllIntegrators) {
    for (const double friction : {0.1, 0.5, 1.0}) {
      SpringSolver solver(incline(std::atan(0.99 * friction), friction),
                          {.integrator = integrator});
      const Vec start = solver.system().bodies[0].positions;
      for (int n = 0; n < 1000; ++n) {
        const StepOutcome outcome = solver.step(kStep);
        ASSERT_EQ(outcome.contact.num_contacts, 1) << name_of(integrator) << n;
        ASSERT_TRUE(outcome.contact.converged);
        ASSERT_LT(solver.system().bodies[0].velocities.norm(), kCreep) << name_of(integrator);
      }
      const Vec moved = solver.system().bodies[0].positions.col(0) - start;
      EXPECT_LT(moved.norm(), kCreep * solver.time());
    }
  }
}

TEST(Incline, SlidesWithTheCoulombAccelerationAboveIt) {
  constexpr double kStep = 0.005;  // [s]
  constexpr int kSteps = 1000;
  // Constant acceleration: every method's velocity is exact, but explicit Euler's misses its first
  // contact step.
  constexpr double kTruncation = 1.5 / kSteps;
  for (const IntegratorKind integrator : kAllIntegrators) {
    for (const double friction : {0.0, 0.1, 0.5, 1.0}) {
      for (const double slope : {std::atan(1.01 * friction + 1e-3), std::atan(friction) + 0.3}) {
        SpringSolver solver(incline(slope, friction), {.integrator = integrator});
        for (int n = 0; n < kSteps; ++n) (void)solver.step(kStep);
        const Vec downhill(-std::cos(slope), -std::sin(slope), 0);
        const double speed = downhill.dot(solver.system().bodies[0].velocities.col(0));
        const double acceleration = kGravity * (std::sin(slope) - friction * std::cos(slope));
        EXPECT_NEAR(speed / solver.time(), acceleration, kTruncation * acceleration)
            << name_of(integrator) << ", friction " << friction;
      }
    }
  }
}

TEST(Incline, ANodeBrakesToRestAndStays) {
  System system = incline(0.0, 0.4);
  constexpr double kSpeed = 2.0;  // [m/s]
  constexpr double kStep = 0.001;
  system.bodies[0].velocities.col(0) << kSpeed, 0, 0;
  SpringSolver solver(std::move(system));
  const double stop_time = kSpeed / (0.4 * kGravity);
  while (solver.time() < stop_time + 2 * kStep) (void)solver.step(kStep);
  EXPECT_LT(solver.system().bodies[0].velocities.norm(), 1e-12);  // round-off of g h
  // Modified Euler stops short by v h / 2, half a step of its first order.
  const double distance = kSpeed * kSpeed / (2 * 0.4 * kGravity);
  EXPECT_NEAR(solver.system().bodies[0].positions(0, 0), distance, kSpeed * kStep);
}

TEST(Sphere, ANodeThatSticksDoesNotCreep) {
  for (const IntegratorKind integrator : kAllIntegrators) {
    System system = system_of(make_free_node(0.2, Vec::Zero(), {0, -kGravity, 0}));
    constexpr double kRadius = 0.5;
    system.colliders.push_back({.name = "ball", .shape = Sphere{kRadius}});
    Body& node = system.bodies[0];
    node.friction = 1.0;
    node.collision_margin = kMargin;
    const Vec start = (kRadius + kMargin) * Vec(std::sin(0.6), std::cos(0.6), 0);
    node.positions = start;
    SpringSolver solver(std::move(system), {.integrator = integrator});
    for (int n = 0; n < 2000; ++n) ASSERT_TRUE(solver.step(0.005).contact.converged);
    // kNormalTolerance per step of g h^2 = 2.5e-4 m, so 1e-12 m in all.
    EXPECT_LT((solver.system().bodies[0].positions.col(0) - start).norm(), 1e-12)
        << name_of(integrator);
  }
}

}  // namespace
}  // namespace weft::reference::testing
