// Pinned nodes with a velocity, and laws that know the time.
#include <cmath>

#include <gtest/gtest.h>

#include <weft/core/error.hpp>

#include "tests/reference/small_systems.hpp"

namespace weft::reference::testing {
namespace {

TEST(PrescribedMotion, PinnedNodesKeepTheirVelocityInEveryIntegrator) {
  const Vector3<double> velocity(0.3, -0.2, 0.1);
  for (const IntegratorKind integrator : kAllIntegrators) {
    Body body = make_chain(4, 0.5, 0.1, 20.0);
    body.mesh.pinned = {0, 3};
    body.mesh.pinned_velocities = Matrix3X<double>::Zero(3, 2);
    body.mesh.pinned_velocities.col(0) = velocity;
    add_law(body, "velocity_damping", {{"rate", {2.0}}});
    SpringSolver solver = solver_of(std::move(body), integrator);
    const int num_steps = 200;
    const double step = 1e-3;
    for (int i = 0; i < num_steps; ++i) ASSERT_FALSE(solver.step(step).blow_up);
    const Body& end = solver.system().bodies[0];
    const Vector3<double> way = num_steps * step * velocity;
    EXPECT_EQ(Vector3<double>(end.velocities.col(0)), velocity) << name_of(integrator);
    EXPECT_NEAR((end.positions.col(0) - way).norm(), 0, num_steps * kEpsilon * way.norm());
    EXPECT_EQ(end.positions.col(3), end.mesh.rest_positions.col(3)) << name_of(integrator);
  }
}

TEST(PrescribedMotion, VelocitiesThatDoNotFitThePinsAreRefused) {
  Body body = make_chain(4, 0.5, 0.1, 20.0);
  body.mesh.pinned = {0, 3};
  body.mesh.pinned_velocities = Matrix3X<double>::Zero(3, 1);
  EXPECT_THROW((void)solver_of(std::move(body), IntegratorKind::kModifiedEuler), InvalidArgument);
}

constexpr double kFrequency = 3.0;  // sqrt(k / m) [rad/s]
constexpr double kSpeed = 0.5;      // of the target [m/s]
constexpr double kEndTime = 1.0;    // [s]
constexpr double kStart = 0.2;      // [m]

/// Error at the end of a node that a spring draws behind a target, from x = 0.2 m at rest:
/// x = u t + x0 cos(w t) - u sin(w t) / w.
double drawn_error(IntegratorKind integrator, int num_steps) {
  const double mass = 0.2;
  Body body = make_free_node(mass, {0, 0, 0}, {0, 0, 0});
  body.positions(0, 0) = kStart;
  body.mesh.node_sets = {{"hand", {0}}};
  add_law(body, "drive",
          {{"stiffness", {mass * kFrequency * kFrequency}}, {"velocity", {kSpeed, 0, 0}}});
  SpringSolver solver = solver_of(std::move(body), integrator);
  for (int i = 0; i < num_steps; ++i) (void)solver.step(kEndTime / num_steps);
  const double angle = kFrequency * kEndTime;
  const double exact =
      kSpeed * kEndTime + kStart * std::cos(angle) - kSpeed * std::sin(angle) / kFrequency;
  return std::abs(solver.system().bodies[0].positions(0, 0) - exact);
}

TEST(PrescribedMotion, LawsKnowTheTimeOfEveryStage) {
  // A stage at a wrong time makes every method first order.
  const int steps[] = {0, 2000, 200, 0, 50, 20};  // of each order
  constexpr double kOrderMargin = 0.1;            // the next term of the error's series
  for (const IntegratorKind integrator : kAllIntegrators) {
    const int expected = make_integrator(integrator)->order();
    const int coarse = steps[expected];
    const double order =
        std::log2(drawn_error(integrator, coarse) / drawn_error(integrator, 2 * coarse));
    EXPECT_NEAR(order, expected, kOrderMargin) << name_of(integrator);
  }
}

TEST(PrescribedMotion, SubstepsGoOnInTime) {
  Body body = make_free_node(1.0, {0, 0, 0}, {0, 0, 0});
  body.mesh.node_sets = {{"hand", {0}}};
  add_law(body, "drive", {{"stiffness", {1e4}}, {"velocity", {kSpeed, 0, 0}}});
  SpringSolver whole(system_of(std::move(body)), {.guard = GuardPolicy::kSubstep});
  const StepOutcome outcome = whole.step(0.1);
  ASSERT_GT(outcome.substeps, 1);
  const double h = 0.1 / outcome.substeps;
  double x = 0, v = 0;
  for (int i = 0; i < outcome.substeps; ++i) {
    v += h * 1e4 * (kSpeed * (i * h) - x);
    x += h * v;
  }
  // Each step amplifies rounding by at most 1 + w h < 3, few steps: far above n eps, far below h.
  EXPECT_NEAR(whole.system().bodies[0].positions(0, 0), x, 1e-12 * kSpeed);
}

}  // namespace
}  // namespace weft::reference::testing
