#include <cmath>

#include <gtest/gtest.h>

#include <weft/core/error.hpp>
#include <weft/reference/balance.hpp>

#include "tests/reference/small_systems.hpp"

namespace weft::reference::testing {
namespace {

constexpr IntegratorKind kImplicit[] = {IntegratorKind::kImplicitEuler, IntegratorKind::kTrBdf2,
                                        IntegratorKind::kImplicitMidpoint,
                                        IntegratorKind::kGeneralizedAlpha};

/// A hanging cloth with laws of every kind: springs, hinges, wind on faces, dampers of the whole body
/// and added inertia.
Body busy_cloth() {
  Body body = make_cloth(8, 1.0, 0.3, 0.0, 300.0, 0.05);
  body.mesh.pinned = {0, 7};
  add_law(body, "gravity", {{"acceleration", {0, -9.81, 0}}});
  add_law(body, "hinge_torsion", {{"rigidity", {2e-3}}});
  add_law(body, "wind", {{"velocity", {2.0, 0.5, 1.0}}});
  add_law(body, "velocity_damping", {{"rate", {0.5}}});
  add_law(body, "rotation_damping", {{"rate", {3.0}}});
  add_law(body, "acceleration_damping", {{"beta", {0.5}}});
  return body;
}

TEST(ImplicitIntegrators, SolveTheirStagesToTheStatedResidualWithEveryKindOfLaw) {
  constexpr double kWeight = 0.3 * 9.81;  // [N]
  for (const IntegratorKind integrator : kImplicit) {
    SpringSolver solver = solver_of(busy_cloth(), integrator);
    const double h = 10 * solver_of(busy_cloth(), IntegratorKind::kVelocityVerlet)
                              .stability()
                              .stable_step;  // far beyond what an explicit method can take
    int iterations = 0;
    for (int n = 0; n < 20; ++n) {
      const StepOutcome outcome = solver.step(h);
      ASSERT_FALSE(outcome.blow_up) << name_of(integrator);
      EXPECT_TRUE(outcome.integration.converged) << name_of(integrator) << ", step " << n;
      // Rounding: positions of 1 m times a node's springs of some 1e3 N/m, 2e-13 N.
      EXPECT_LT(outcome.integration.residual, 1e-11 * kWeight) << name_of(integrator) << n;
      iterations += outcome.integration.newton_iterations;
    }
    EXPECT_GT(iterations, 20) << "a stage without an iteration is no stage";
    EXPECT_LT(iterations, 20 * 2 * 12) << name_of(integrator);
  }
}

TEST(ImplicitIntegrators, AgreeWithRungeKuttaWithEveryKindOfLaw) {
  constexpr double kDuration = 0.1;  // [s]
  const auto end = [&](IntegratorKind integrator, int steps) {
    SpringSolver solver = solver_of(busy_cloth(), integrator);
    for (int n = 0; n < steps; ++n) (void)solver.step(kDuration / steps);
    return Matrix3X<double>(solver.system().bodies[0].positions);
  };
  const Matrix3X<double> solution = end(IntegratorKind::kRungeKutta4, 2000);
  for (const IntegratorKind integrator :
       {IntegratorKind::kTrBdf2, IntegratorKind::kImplicitMidpoint,
        IntegratorKind::kGeneralizedAlpha, IntegratorKind::kImplicitEuler}) {
    const int order = make_integrator(integrator)->order();
    const int steps = order == 1 ? 400 : 100;
    const double coarse = (end(integrator, steps) - solution).norm();
    const double fine = (end(integrator, 2 * steps) - solution).norm();
    constexpr double kOrderTolerance = 0.15;
    EXPECT_NEAR(std::log2(coarse / fine), order, kOrderTolerance)
        << name_of(integrator) << ": " << coarse << " " << fine;
  }
}

TEST(ImplicitEuler, FindsTheEquilibriumWithLargeSteps) {
  Body body = make_cloth(8, 1.0, 0.3, 0.0, 300.0, 0.05);
  body.mesh.pinned = {0, 7};
  add_law(body, "gravity", {{"acceleration", {0, -9.81, 0}}});
  add_law(body, "hinge_torsion", {{"rigidity", {2e-3}}});
  add_law(body, "velocity_damping", {{"rate", {2.0}}});
  SpringSolver solver = solver_of(std::move(body), IntegratorKind::kImplicitEuler);
  for (int n = 0; n < 150; ++n) ASSERT_TRUE(solver.step(0.1).integration.converged) << n;
  // A step of 0.1 s is some fifty stable ones; exp(-15 s x 1/s) = 3e-7 is left of 1 m/s at most.
  EXPECT_LT(solver.system().bodies[0].velocities.cwiseAbs().maxCoeff(), 1e-6);
}

TEST(ImplicitMidpoint, KeepsTheAngularMomentumOfASpinningCloth) {
  Body body = make_cloth(6, 1.0, 0.3, 0.0, 100.0, 0.0);
  for (int i = 0; i < body.mesh.num_nodes(); ++i) {
    const Vector3<double> position = body.positions.col(i);
    body.velocities.col(i) = Vector3<double>(0.3, 2.0, -0.4).cross(position);
  }
  SpringSolver solver = solver_of(std::move(body), IntegratorKind::kImplicitMidpoint);
  const Vector3<double> start = angular_momentum(solver.system());
  for (int n = 0; n < 200; ++n) (void)solver.step(0.02);
  // A quadratic invariant: the method keeps it, the iteration to kNewtonStep squared.
  EXPECT_LT((angular_momentum(solver.system()) - start).norm(), 1e-11 * start.norm());
}

/// What is left of an oscillation that a step of 1000 radians does not resolve, after each step.
double rest_of_fast_oscillation(const SolverOptions& options, int steps) {
  Body body = make_chain(2, 1.0, 1.0, 1e6);
  body.mesh.pinned = {0};
  constexpr double kStart = 1e-7;  // [m]: stages go 1000 times as far, and the spring has 1 m
  body.positions(0, 1) += kStart;
  SpringSolver solver(system_of(std::move(body)), options);
  for (int n = 0; n < steps; ++n) (void)solver.step(1.0);
  return std::abs(solver.system().bodies[0].positions(0, 1) - 1.0) / kStart;
}

TEST(ImplicitIntegrators, LeaveOfAnUnresolvedOscillationWhatTheySay) {
  constexpr double kInverse = 1e-3;  // 1 / (w h): what a finite step leaves
  EXPECT_LT(rest_of_fast_oscillation({.integrator = IntegratorKind::kImplicitEuler}, 1), kInverse);
  EXPECT_LT(rest_of_fast_oscillation({.integrator = IntegratorKind::kTrBdf2}, 1), 10 * kInverse);
  EXPECT_NEAR(rest_of_fast_oscillation({.integrator = IntegratorKind::kImplicitMidpoint}, 1), 1.0,
              kInverse);
  // Generalised alpha decays with rho^n, times a polynomial: the double root at infinity.
  for (const double rho : {0.0, 0.5, 0.9}) {
    SolverOptions options{.integrator = IntegratorKind::kGeneralizedAlpha};
    options.settings.spectral_radius = rho;
    const double after_50 = rest_of_fast_oscillation(options, 50);
    const double after_100 = rest_of_fast_oscillation(options, 100);
    if (rho == 0.0) {
      EXPECT_LT(after_50, kInverse);
    } else {
      // 5: the polynomial, at most quadratic. The end: rounding of the 1 m spring over the start.
      EXPECT_LT(after_100, 5 * std::pow(rho, 50) * after_50 + 1e-8) << rho;
    }
  }
}

TEST(DormandPrince5, ErrsByWhatItsToleranceSaysAndTellsItsSteps) {
  const auto pendulum = [] {
    Body body = make_chain(2, 1.0, 1.0, 100.0);
    body.mesh.pinned = {0};
    body.positions.col(1) << 0.6, -1.2, 0.0;
    add_law(body, "gravity", {{"acceleration", {0, -9.81, 0}}});
    return body;
  };
  int previous = 0;
  for (const double tolerance : {1e-6, 1e-8, 1e-10, 1e-12}) {
    SolverOptions options{.integrator = IntegratorKind::kDormandPrince5};
    options.settings.relative_tolerance = tolerance;
    options.settings.absolute_tolerance = tolerance;
    SpringSolver solver(system_of(pendulum()), options);
    int inner = 0;
    for (int n = 0; n < 4; ++n) {
      const StepOutcome outcome = solver.step(0.5);
      EXPECT_TRUE(outcome.integration.converged);
      inner += outcome.integration.inner_steps;
    }
    // At 2 s, from an independent Runge-Kutta solution with an error of 1e-8 m.
    const Vector3<double> solution(.445570232, -1.005587065, 0);
    const double error = (solver.system().bodies[0].positions.col(1) - solution).norm();
    // Some hundred inner steps, each with its tolerance, and errors grow a few times over 2 s.
    EXPECT_LT(error, 100 * tolerance + 2e-8) << tolerance;
    EXPECT_GT(inner, previous) << tolerance;
    // Order 5: a hundredth of the tolerance takes 100^(1/5) = 2.5 times as many steps.
    if (previous > 0) {
      EXPECT_LT(inner, 3 * previous) << tolerance;
    }
    previous = inner;
  }
}

TEST(Yoshida4, DoesNotDriftInEnergy) {
  Body body = make_chain(2, 1.0, 1.0, 100.0);
  body.mesh.pinned = {0};
  body.positions.col(1) << 0.6, -1.2, 0.0;
  add_law(body, "gravity", {{"acceleration", {0, -9.81, 0}}});
  SpringSolver solver = solver_of(std::move(body), IntegratorKind::kYoshida4);
  const double start = energies(solver.system()).total();
  double first = 0.0, last = 0.0;  // largest error in the first and in the last tenth
  constexpr int kSteps = 20000;
  for (int n = 0; n < kSteps; ++n) {
    (void)solver.step(0.005);
    const double error = std::abs(energies(solver.system()).total() - start);
    if (n < kSteps / 10) first = std::max(first, error);
    if (n >= kSteps - kSteps / 10) last = std::max(last, error);
  }
  EXPECT_GT(first, 0.0);
  EXPECT_LT(last, 2 * first);  // bounded: a drift would make it ten times as large
}

TEST(Integrators, SettingsOutOfTheirDomainAreRefused) {
  EXPECT_THROW((void)make_integrator(IntegratorKind::kGeneralizedAlpha, {.spectral_radius = 1.5}),
               InvalidArgument);
  EXPECT_THROW((void)make_integrator(IntegratorKind::kDormandPrince5, {.relative_tolerance = 0.0}),
               InvalidArgument);
}

}  // namespace
}  // namespace weft::reference::testing
