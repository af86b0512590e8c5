#include <cmath>

#include <gtest/gtest.h>

#include "tests/reference/small_systems.hpp"

namespace weft::reference::testing {
namespace {

using Eigen::Matrix2d;
using Eigen::Matrix3d;
using Eigen::Vector2d;

/// x'' = -w^2 x - (spring + velocity) x'.
struct Oscillator {
  double omega;          // w [rad/s]
  double spring_rate;    // c / m of the dashpot along the spring [1/s]
  double velocity_rate;  // gamma of velocity_damping [1/s]
};

/// What each method does to (x, v) in one step h, worked out by hand from its definition.
Matrix2d propagation(IntegratorKind integrator, const Oscillator& o, double h) {
  const double w2 = o.omega * o.omega;
  const double a = h * h * w2;
  const double g = h * o.spring_rate;
  Matrix2d system;
  system << 0, 1, -w2, -(o.spring_rate + o.velocity_rate);
  Matrix2d step = Matrix2d::Zero();
  switch (integrator) {
    case IntegratorKind::kExplicitEuler:
      return Matrix2d::Identity() + h * system;
    case IntegratorKind::kModifiedEuler: {
      const double decay = std::exp(-h * o.velocity_rate);
      step << 1 - a, h * (1 - g), -decay * h * w2, decay * (1 - g);
      return step;
    }
    case IntegratorKind::kVelocityVerlet: {
      step << 1 - a / 2, h * (1 - g / 2), (-a + a * a / 4 + g * a / 2) / h,
          1 - g - a / 2 + a * g / 4 + g * g / 2;
      const Vector2d half(1.0, std::exp(-0.5 * h * o.velocity_rate));
      return half.asDiagonal() * step * half.asDiagonal();
    }
    case IntegratorKind::kRungeKutta4: {
      const Matrix2d z = h * system;
      return Matrix2d::Identity() + z + z * z / 2 + z * z * z / 6 + z * z * z * z / 24;
    }
    case IntegratorKind::kDormandPrince5: {
      const Matrix2d z = h * system;
      const Matrix2d z2 = z * z, z3 = z2 * z;
      return Matrix2d::Identity() + z + z2 / 2 + z3 / 6 + z2 * z2 / 24 + z2 * z3 / 120 +
             z3 * z3 / 600;
    }
    case IntegratorKind::kYoshida4: {
      const double w1 = 1 / (2 - std::cbrt(2.0));
      step.setIdentity();
      for (const double part : {w1, 1 - 2 * w1, w1}) {
        const double s = part * h;
        const double c = o.spring_rate + o.velocity_rate;
        Matrix2d kick, drift;  // over s / 2 and s
        kick << 1, 0, -s / 2 * w2 / (1 + s * c / 4), (1 - s * c / 4) / (1 + s * c / 4);
        drift << 1, s, 0, 1;
        step = kick * drift * kick * step;
      }
      return step;
    }
    case IntegratorKind::kImplicitEuler:
      return (Matrix2d::Identity() - h * system).inverse();
    case IntegratorKind::kImplicitMidpoint:
      return (Matrix2d::Identity() - h / 2 * system).inverse() *
             (Matrix2d::Identity() + h / 2 * system);
    case IntegratorKind::kTrBdf2: {
      const double part = 2 - std::sqrt(2.0);
      const Matrix2d inverse = (Matrix2d::Identity() - part / 2 * h * system).inverse();
      const Matrix2d middle = inverse * (Matrix2d::Identity() + part / 2 * h * system);
      const double scale = 1 / (part * (2 - part));
      return inverse * (scale * middle - scale * (1 - part) * (1 - part) * Matrix2d::Identity());
    }
    case IntegratorKind::kGeneralizedAlpha:
      break;  // has a state of three numbers: alpha_propagation()
  }
  return step;
}

/// Generalised alpha on (x, v, a), from its four equations.
Matrix3d alpha_propagation(double rho, const Oscillator& o, double h) {
  const double w2 = o.omega * o.omega;
  const double c = o.spring_rate + o.velocity_rate;
  const double am = (2 * rho - 1) / (rho + 1), af = rho / (rho + 1);
  const double gamma = 0.5 - am + af, beta = std::pow(1 - am + af, 2) / 4;
  // Unknowns (x1, v1, a1): left (x1, v1, a1) = right (x0, v0, a0).
  Matrix3d left, right;
  left << 1, 0, -h * h * beta, 0, 1, -h * gamma, (1 - af) * w2, (1 - af) * c, 1 - am;
  right << 1, h, h * h * (0.5 - beta), 0, 1, h * (1 - gamma), -af * w2, -af * c, -am;
  return left.inverse() * right;
}

constexpr double kMass = 0.3;        // [kg]
constexpr double kStiffness = 30.0;  // [N/m]
constexpr double kAmplitude = 0.25;  // [m], of a spring of 1 m
constexpr int kSteps = 1500;

Body damped_chain(const Oscillator& o, double reduced_mass) {
  Body body = make_chain(2, 1.0, kMass, kStiffness);
  if (o.spring_rate > 0) {
    add_law(body, "spring_damping", {{"damping", {o.spring_rate * reduced_mass}}});
  }
  if (o.velocity_rate > 0) add_law(body, "velocity_damping", {{"rate", {o.velocity_rate}}});
  return body;
}

void expect_discrete_formula(IntegratorKind integrator, const Oscillator& o, Body body,
                             const std::string& what) {
  const double h = 0.1 / o.omega;
  body.positions(0, 1) += kAmplitude;
  Eigen::VectorXd expected = Vector2d(kAmplitude, 0.0);
  Eigen::MatrixXd matrix = propagation(integrator, o, h);
  if (integrator == IntegratorKind::kGeneralizedAlpha) {
    expected = Eigen::Vector3d(kAmplitude, 0.0, -o.omega * o.omega * kAmplitude);
    matrix = alpha_propagation(IntegratorSettings{}.spectral_radius, o, h);
  }
  double scale = 0.0;  // largest amplitude so far: a decayed tail keeps the rounding of its start
  SpringSolver solver = solver_of(std::move(body), integrator);
  for (int n = 0; n < kSteps; ++n) {
    ASSERT_FALSE(solver.step(h).blow_up);
    expected = matrix * expected;
    scale = std::max({scale, std::abs(expected[0]), std::abs(expected[1]) / o.omega});
  }
  // Round-off: one rounding of the 1 m spring per step; an explicit Euler run also amplifies it.
  constexpr double kTolerance = 1e-9;
  const Body& end = solver.system().bodies[0];
  const double x = end.positions(0, 1) - end.positions(0, 0) - 1.0;
  const double v = end.velocities(0, 1) - end.velocities(0, 0);
  EXPECT_NEAR(x, expected[0], kTolerance * scale) << what;
  EXPECT_NEAR(v, expected[1], kTolerance * scale * o.omega) << what;
}

TEST(Integrators, MassOnPinnedSpringFollowsTheDiscreteFormula) {
  const double omega = std::sqrt(kStiffness / kMass);
  for (const IntegratorKind integrator : kAllIntegrators) {
    // Explicit Euler undamped would leave the spring's linear range (it grows 1700-fold), so it is
    // damped enough to stay inside; its growth is tested in solver_test.
    const bool grows = integrator == IntegratorKind::kExplicitEuler;
    const double base = grows ? 1.2 : 0.0;
    for (const Oscillator& o : {Oscillator{omega, base, 0.0}, Oscillator{omega, base + 0.4, 0.0},
                                Oscillator{omega, base, 0.7}, Oscillator{omega, base + 0.4, 0.7}}) {
      Body body = damped_chain(o, kMass);
      body.mesh.pinned = {0};
      expect_discrete_formula(integrator, o, std::move(body), name_of(integrator));
    }
  }
}

TEST(Integrators, TwoMassesFollowTheDiscreteFormulaOfTheReducedMass) {
  const double reduced_mass = kMass / 2;
  for (const IntegratorKind integrator : kAllIntegrators) {
    const Oscillator o{std::sqrt(kStiffness / reduced_mass), 1.7, 0.3};
    expect_discrete_formula(integrator, o, damped_chain(o, reduced_mass), name_of(integrator));
  }
}

TEST(Integrators, AFormulaWithAnotherRateIsTold) {
  // Negative control of the two tests above: a rate off by 1e-6 must be seen.
  const double omega = std::sqrt(kStiffness / kMass);
  const Oscillator right{omega, 0.4, 0.7};
  const Oscillator wrong{omega * (1 + 1e-6), 0.4, 0.7};
  const double h = 0.1 / omega;
  for (const IntegratorKind integrator : kAllIntegrators) {
    if (integrator == IntegratorKind::kGeneralizedAlpha) continue;  // not by propagation()
    Vector2d x(1, 0), y(1, 0);
    const Matrix2d first = propagation(integrator, right, h);
    const Matrix2d second = propagation(integrator, wrong, h);
    double largest = 0.0;
    for (int n = 0; n < kSteps; ++n) {
      x = first * x;
      y = second * y;
      largest = std::max(largest, (x - y).norm());
    }
    EXPECT_GT(largest, 1e-7) << name_of(integrator);
  }
}

TEST(ModifiedEuler, ConservesItsOwnEnergyExactly) {
  Body body = make_chain(2, 1.0, kMass, kStiffness);
  body.mesh.pinned = {0};
  body.positions(0, 1) += 0.5;
  const double omega = std::sqrt(kStiffness / kMass);
  const double h = 0.2 / omega;
  SpringSolver solver = solver_of(std::move(body), IntegratorKind::kModifiedEuler);
  const auto invariant = [&] {
    const Body& now = solver.system().bodies[0];
    const double x = now.positions(0, 1) - 1.0;
    const double v = now.velocities(0, 1);
    return v * v + omega * omega * x * x - h * omega * omega * x * v;
  };
  const double start = invariant();
  double largest = 0.0;
  for (int n = 0; n < 100000; ++n) {
    (void)solver.step(h);
    largest = std::max(largest, std::abs(invariant() - start));
  }
  // Round-off: a random walk of 1e5 roundings of 2e-16 is 7e-14; 1e-12 is the stated precision.
  EXPECT_LT(largest, 1e-12 * start);
}

/// m = 1 kg, k = 100 N/m, l0 = 1 m, g = 9.81 m/s^2, released at (0.6, -1.2).
Body spring_pendulum() {
  Body body = make_chain(2, 1.0, 1.0, 100.0);
  body.mesh.pinned = {0};
  body.positions.col(1) << 0.6, -1.2, 0.0;
  add_law(body, "gravity", {{"acceleration", {0, -9.81, 0}}});
  return body;
}

TEST(MethodsOfHighOrder, ReproduceTheSpringPendulumTable) {
  // Time [s], x, y [m]: an independent Runge-Kutta solution, error <= 1e-8.
  const double table[][3] = {{0.5, -.069627411, -1.217504590},
                             {1.0, -.348251841, -.821392145},
                             {2.0, .445570232, -1.005587065},
                             {5.0, -.526191324, -1.186708980},
                             {10.0, .347049829, -1.137932779}};
  constexpr double kTableError = 1e-8;   // [m]
  constexpr int kStepsPerSecond = 4000;  // discretization error (w h)^4 w T / 120 = 3e-11 m
  for (const IntegratorKind integrator :
       {IntegratorKind::kRungeKutta4, IntegratorKind::kYoshida4, IntegratorKind::kDormandPrince5}) {
    SpringSolver solver = solver_of(spring_pendulum(), integrator);
    int done = 0;
    for (const auto& row : table) {
      for (; done < std::lround(row[0] * kStepsPerSecond); ++done) {
        (void)solver.step(1.0 / kStepsPerSecond);
      }
      EXPECT_NEAR(solver.system().bodies[0].positions(0, 1), row[1], kTableError)
          << row[0] << name_of(integrator);
      EXPECT_NEAR(solver.system().bodies[0].positions(1, 1), row[2], kTableError)
          << row[0] << name_of(integrator);
      if (done == kStepsPerSecond / 2) {
        EXPECT_NEAR(solver.system().bodies[0].velocities(0, 1), -1.285588836, 10 * kTableError);
        EXPECT_NEAR(solver.system().bodies[0].velocities(1, 1), -2.354737000, 10 * kTableError);
      }
    }
  }
}

Body damped_pendulum() {
  Body body = spring_pendulum();
  add_law(body, "spring_damping", {{"damping", {2.0}}});
  add_law(body, "velocity_damping", {{"rate", {1.0}}});
  return body;
}

Eigen::VectorXd end_state(Body body, IntegratorKind integrator, int steps) {
  constexpr double kDuration = 0.5;  // [s]
  SpringSolver solver = solver_of(std::move(body), integrator);
  for (int n = 0; n < steps; ++n) (void)solver.step(kDuration / steps);
  Eigen::VectorXd state(6);
  state << solver.system().bodies[0].positions.col(1), solver.system().bodies[0].velocities.col(1);
  return state;
}

void expect_orders(Body (*make)()) {
  const Eigen::VectorXd solution = end_state(make(), IntegratorKind::kRungeKutta4, 8000);
  const struct {
    IntegratorKind integrator;
    int order;
    int steps;         // enough to be in the asymptotic range
    int halvings = 3;  // few enough to stay above rounding, 1e-14 m
  } cases[] = {
      {IntegratorKind::kExplicitEuler, 1, 8000},   {IntegratorKind::kModifiedEuler, 1, 2000},
      {IntegratorKind::kVelocityVerlet, 2, 200},   {IntegratorKind::kRungeKutta4, 4, 100},
      {IntegratorKind::kYoshida4, 4, 100},         {IntegratorKind::kDormandPrince5, 5, 100, 2},
      {IntegratorKind::kImplicitEuler, 1, 2000},   {IntegratorKind::kTrBdf2, 2, 200},
      {IntegratorKind::kImplicitMidpoint, 2, 200}, {IntegratorKind::kGeneralizedAlpha, 2, 200}};
  constexpr double kOrderTolerance = 0.15;
  for (const auto& c : cases) {
    double previous = 0.0;
    for (int halving = 0; halving <= c.halvings; ++halving) {
      const double error = (end_state(make(), c.integrator, c.steps << halving) - solution).norm();
      if (halving > 0) {
        EXPECT_NEAR(std::log2(previous / error), c.order, kOrderTolerance)
            << name_of(c.integrator) << ", halving " << halving << ", error " << error;
      }
      previous = error;
    }
    EXPECT_EQ(make_integrator(c.integrator)->order(), c.order);
  }
}

TEST(Integrators, HaveTheirOrderOnASpringPendulum) {
  expect_orders(&spring_pendulum);
}

TEST(Integrators, KeepTheirOrderWithDashpotAndVelocityDamping) {
  expect_orders(&damped_pendulum);
}

}  // namespace
}  // namespace weft::reference::testing
