#include <cmath>

#include <gtest/gtest.h>

#include <weft/reference/balance.hpp>
#include <weft/reference/rigid/free_rotation.hpp>

#include "tests/reference/small_systems.hpp"

namespace weft::reference::testing {
namespace {

using Vec = Vector3<double>;

Collider spinning(const Shape& shape, const Vec& angular_velocity) {
  Collider body{.name = "body", .shape = shape};
  body.mass = 0.3;
  body.orientation = Eigen::AngleAxisd(0.7, Vec(1, -2, 3).normalized());
  body.angular_velocity = angular_velocity;
  return body;
}

System alone(const Collider& body) {
  System system;
  system.colliders.push_back(body);
  return system;
}

/// The bodies that a wrong rotation spins up most: a needle, a plate, and no two equal moments.
const Shape kShapes[] = {Cylinder{0.01, 0.5}, Cylinder{0.5, 0.01}, Box{{0.3, 0.1, 0.2}},
                         Box{{0.5, 0.01, 0.03}}, Capsule{0.02, 0.4}};

TEST(FreeRotation, KeepsAngularMomentumAndEnergyForTenSecondsWithEveryIntegrator) {
  for (const Shape& shape : kShapes) {
    for (const IntegratorKind integrator : kAllIntegrators) {
      SpringSolver solver(alone(spinning(shape, {10, 5, 10})), {.integrator = integrator});
      const Vec momentum = angular_momentum(solver.system());
      const double energy = energies(solver.system()).kinetic;
      double momentum_error = 0.0, energy_error = 0.0;
      for (int n = 0; n < 10000; ++n) {
        ASSERT_FALSE(solver.step(0.001).blow_up);
        momentum_error =
            std::max(momentum_error, (angular_momentum(solver.system()) - momentum).norm());
        energy_error = std::max(energy_error, std::abs(energies(solver.system()).kinetic - energy));
      }
      EXPECT_LT(momentum_error, 1e-9 * momentum.norm()) << name_of(integrator) << shape.index();
      EXPECT_LT(energy_error, 1e-9 * energy) << name_of(integrator) << shape.index();
    }
  }
}

TEST(FreeRotation, FollowsStepsOfManyRadians) {
  // 1.5 to 15 rad in a step, which no scheme that turns once a step survives.
  for (const Shape& shape : kShapes) {
    SpringSolver solver(alone(spinning(shape, {10, 5, 10})));
    const double energy = energies(solver.system()).kinetic;
    for (const double step : {0.1, 1.0}) {
      for (int n = 0; n < 100; ++n) (void)solver.step(step);
      EXPECT_NEAR(energies(solver.system()).kinetic, energy, 1e-9 * energy) << shape.index();
    }
  }
}

TEST(FreeRotation, TurnsASymmetricTopExactlyInOneStep) {
  // Steady precession: the axis goes round the angular momentum at L / I_across, and the body about
  // its axis at what is left, in the closed form of any textbook.
  const Collider top = spinning(Cylinder{0.1, 0.5}, {3, 20, -4});
  const Vec moments = principal_inertia(top);
  const Vec momentum = world_inertia(top) * top.angular_velocity;
  constexpr double kTime = 7.3;  // [s], about 140 rad
  const Eigen::Quaterniond end = FreeRotation(moments, momentum).advance(top.orientation, kTime);
  const Vec axis = top.orientation * Vec::UnitY();
  const double spin = momentum.dot(axis) * (1 / moments.y() - 1 / moments.x());
  const Eigen::Quaterniond expected =
      Eigen::AngleAxisd(kTime * momentum.norm() / moments.x(), momentum.normalized()) *
      top.orientation * Eigen::AngleAxisd(kTime * spin, Vec::UnitY());
  EXPECT_LT(end.angularDistance(expected), 1e-12);
}

TEST(FreeRotation, ConvergesToEulersEquations) {
  // Truth: q' = w q / 2 with w = I^-1 L by the classical Runge-Kutta method in 200,000 steps.
  const Collider box = spinning(Box{{0.3, 0.1, 0.2}}, {3, 1, -7});
  const Vec momentum = world_inertia(box) * box.angular_velocity;
  const FreeRotation rotation(principal_inertia(box), momentum);
  const auto rate = [&](const Eigen::Vector4d& q) -> Eigen::Vector4d {
    const Vec w = rotation.angular_velocity(Eigen::Quaterniond(q).normalized());
    return 0.5 * (Eigen::Quaterniond(0, w.x(), w.y(), w.z()) * Eigen::Quaterniond(q)).coeffs();
  };
  Eigen::Vector4d q = box.orientation.coeffs();
  constexpr int kSteps = 200000;
  constexpr double kStep = 2.0 / kSteps;  // [s]
  for (int n = 0; n < kSteps; ++n) {
    const Eigen::Vector4d a = rate(q), b = rate(q + 0.5 * kStep * a), c = rate(q + 0.5 * kStep * b),
                          d = rate(q + kStep * c);
    q += kStep / 6 * (a + 2 * b + 2 * c + d);
  }
  const Eigen::Quaterniond solution = Eigen::Quaterniond(q).normalized();
  EXPECT_LT(rotation.advance(box.orientation, 2.0).angularDistance(solution), 1e-10);
  EXPECT_LT(rotation.angular_velocity(box.orientation).cross(box.angular_velocity).norm(), 1e-13);
}

TEST(FreeRotation, RefusesToFollowATumblingBeyondItsBudget) {
  // 1e5 rad/s for 0.1 s: finite, but no number in it would mean anything.
  SpringSolver solver(alone(spinning(Box{{0.3, 0.1, 0.2}}, {1e5, 1e5, 1e5})));
  const StepOutcome outcome = solver.step(0.1);
  ASSERT_TRUE(outcome.blow_up);
  EXPECT_NE(outcome.blow_up->reason.find("tumbling in a step by"), std::string::npos)
      << outcome.blow_up->reason;
  EXPECT_TRUE(solver.system().colliders[0].angular_velocity.allFinite());
}

}  // namespace
}  // namespace weft::reference::testing
