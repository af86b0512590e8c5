#include <cmath>

#include <gtest/gtest.h>

#include <weft/core/error.hpp>

#include "tests/reference/small_systems.hpp"

namespace weft::reference::testing {
namespace {

/// Largest displacement from the rest shape, as a multiple of the first one, after some steps.
double growth(Body body, IntegratorKind integrator, double h, int steps) {
  constexpr double kSeed = 1e-9;  // [m], small enough to stay linear while it grows a million times
  Matrix3X<double> start = body.positions;
  std::uint32_t state = 7;
  for (Eigen::Index i = 0; i < start.size(); ++i) {
    state = state * 1664525u + 1013904223u;
    start.data()[i] += kSeed * (static_cast<double>(state) / 2147483648.0 - 1.0);
  }
  for (const int node : body.mesh.pinned) start.col(node) = body.positions.col(node);
  body.positions = start;
  const Matrix3X<double> rest = body.mesh.rest_positions;
  SpringSolver solver(system_of(std::move(body)), {.integrator = integrator});
  for (int n = 0; n < steps; ++n) {
    if (solver.step(h).blow_up) return std::numeric_limits<double>::infinity();
  }
  return (solver.system().bodies[0].positions - rest).cwiseAbs().maxCoeff() / kSeed;
}

// A mode at 0.98 of the stable step swings to 1 / sqrt(1 - 0.98^2) = 5 times its start at most, and
// 3000 steps of drifting zero modes add nothing as the seed has no velocity. One at 1.02 grows by
// exp(2 acosh(1.02)) = 1.5 per step (less where damping sets the limit), in 3000 steps far beyond
// every bound.
constexpr double kBounded = 100.0;
constexpr double kDiverged = 1e4;
constexpr int kSteps = 3000;

Body lattice() {
  return make_cloth(7, 1.0, 0.2, 0.0, 50.0, 0.0);
}

TEST(Spectrum, ChainHasItsClosedFormTopFrequency) {
  constexpr int kSprings = 12;
  constexpr double kStiffness = 80.0, kMass = 0.05;
  Body body = make_chain(kSprings + 1, 0.1, kMass, kStiffness);
  body.mesh.pinned = {0};
  const Spectrum found = spectrum(body);
  const double exact = 2 * std::sqrt(kStiffness / kMass) *
                       std::sin((2 * kSprings - 1) * M_PI / (2.0 * (2 * kSprings + 1)));
  EXPECT_TRUE(found.converged);
  EXPECT_NEAR(found.omega_max, exact, 1e-6 * exact);  // as kRayleighTolerance states
  EXPECT_EQ(found.gamma_force_max, 0.0);
}

TEST(Spectrum, DampingRatesAreThoseOfTheLaws) {
  constexpr double kStiffness = 80.0, kMass = 0.05, kDamping = 0.3, kRate = 4.0;
  Body body = make_chain(2, 0.1, kMass, kStiffness);
  add_law(body, "spring_damping", {{"damping", {kDamping}}});
  add_law(body, "velocity_damping", {{"rate", {kRate}}});
  const Spectrum found = spectrum(body);
  constexpr double kTolerance = 1e-6;  // as kRayleighTolerance states
  EXPECT_NEAR(found.omega_max, std::sqrt(2 * kStiffness / kMass), kTolerance * found.omega_max);
  EXPECT_NEAR(found.gamma_force_max, 2 * kDamping / kMass, kTolerance * found.gamma_force_max);
  EXPECT_NEAR(found.gamma_velocity_max, kRate, kTolerance * kRate);
  EXPECT_NEAR(found.top_mode_damping, 2 * kDamping / kMass + kRate,
              kTolerance * found.top_mode_damping);
}

TEST(Spectrum, NothingMovesAFullyPinnedBody) {
  Body body = make_chain(2, 0.1, 1.0, 10.0);
  body.mesh.pinned = {0, 1};
  const Spectrum found = spectrum(body);
  EXPECT_TRUE(found.converged);
  EXPECT_EQ(stable_step(IntegratorKind::kModifiedEuler, found),
            std::numeric_limits<double>::infinity());
}

TEST(StableStep, DividesBoundedFromDivergingOnALattice) {
  for (const IntegratorKind integrator :
       {IntegratorKind::kModifiedEuler, IntegratorKind::kVelocityVerlet,
        IntegratorKind::kRungeKutta4, IntegratorKind::kYoshida4}) {
    System system = system_of(lattice());
    const double h = assess(system, integrator).stable_step;
    EXPECT_LT(growth(lattice(), integrator, 0.98 * h, kSteps), kBounded) << name_of(integrator);
    EXPECT_GT(growth(lattice(), integrator, 1.02 * h, kSteps), kDiverged) << name_of(integrator);
  }
}

Body oscillator(double spring_rate, double velocity_rate) {
  constexpr double kMass = 0.5, kStiffness = 50.0;  // w = 10 rad/s
  Body body = make_chain(2, 1.0, kMass, kStiffness);
  body.mesh.pinned = {0};
  if (spring_rate > 0) add_law(body, "spring_damping", {{"damping", {spring_rate * kMass}}});
  if (velocity_rate > 0) add_law(body, "velocity_damping", {{"rate", {velocity_rate}}});
  return body;
}

TEST(StableStep, IsExactWithDampingWhereItSaysSo) {
  const struct {
    IntegratorKind integrator;
    double spring_rate, velocity_rate;  // [1/s]
  } cases[] = {{IntegratorKind::kModifiedEuler, 3, 0},  {IntegratorKind::kModifiedEuler, 0, 5},
               {IntegratorKind::kModifiedEuler, 3, 5},  {IntegratorKind::kModifiedEuler, 0, 60},
               {IntegratorKind::kVelocityVerlet, 0, 5}, {IntegratorKind::kVelocityVerlet, 0, 60},
               {IntegratorKind::kExplicitEuler, 3, 0},  {IntegratorKind::kExplicitEuler, 3, 5}};
  for (const auto& c : cases) {
    System system = system_of(oscillator(c.spring_rate, c.velocity_rate));
    const double h = assess(system, c.integrator).stable_step;
    // Explicit Euler grows slowest: by 0.01 h^2 w^2 = 0.0009 per step.
    const int steps = c.integrator == IntegratorKind::kExplicitEuler ? 10 * kSteps : kSteps;
    const auto at = [&](double factor) {
      return growth(oscillator(c.spring_rate, c.velocity_rate), c.integrator, factor * h, steps);
    };
    EXPECT_LT(at(0.98), kBounded) << name_of(c.integrator) << c.spring_rate << c.velocity_rate;
    EXPECT_GT(at(1.02), kDiverged) << name_of(c.integrator) << c.spring_rate << c.velocity_rate;
  }
}

TEST(StableStep, NothingLimitsImplicitMethods) {
  System system = system_of(lattice());
  const double explicit_step = assess(system, IntegratorKind::kVelocityVerlet).stable_step;
  for (const IntegratorKind integrator :
       {IntegratorKind::kImplicitEuler, IntegratorKind::kTrBdf2, IntegratorKind::kImplicitMidpoint,
        IntegratorKind::kGeneralizedAlpha, IntegratorKind::kDormandPrince5}) {
    EXPECT_EQ(assess(system, integrator).stable_step, std::numeric_limits<double>::infinity());
    // The flat lattice has modes out of plane without stiffness, which the start gives no velocity.
    EXPECT_LT(growth(lattice(), integrator, 30 * explicit_step, 300), kBounded)
        << name_of(integrator);
  }
}

TEST(StableStep, IsNeverTooLargeWithDamping) {
  for (const IntegratorKind integrator : kAllIntegrators) {
    if (!std::isfinite(stable_step(integrator, Spectrum{.omega_max = 1.0}))) continue;
    for (const double spring_rate : {0.5, 5.0, 15.0, 19.0, 25.0, 80.0}) {
      for (const double velocity_rate : {0.0, 5.0, 100.0}) {
        System system = system_of(oscillator(spring_rate, velocity_rate));
        const double h = assess(system, integrator).stable_step;
        EXPECT_LT(growth(oscillator(spring_rate, velocity_rate), integrator, 0.98 * h, kSteps),
                  kBounded)
            << name_of(integrator) << ", rates " << spring_rate << " and " << velocity_rate;
      }
    }
  }
}

TEST(StableStep, ExplicitEulerHasNoneWithoutDamping) {
  System system = system_of(lattice());
  EXPECT_EQ(assess(system, IntegratorKind::kExplicitEuler).stable_step, 0.0);
}

TEST(StableStep, ACompressedSpringDoesNotHideTheTopMode) {
  // A chain pressed to half its length: the transverse eigenvalues are negative, -2 k (l0 / l - 1)
  // / m = -2 k / m and so as large as the longitudinal ones.
  constexpr double kMass = 0.1, kStiffness = 20.0;
  Body body = make_chain(3, 1.0, kMass, kStiffness);
  body.mesh.pinned = {0, 2};
  body.positions *= 0.4;
  const Spectrum found = spectrum(body);
  EXPECT_TRUE(found.converged);
  const double exact = std::sqrt(2 * kStiffness / kMass);
  EXPECT_NEAR(found.omega_max, exact, 1e-6 * exact);  // as kRayleighTolerance states
}

TEST(StepGuard, RefusesWithBothNumbers) {
  SpringSolver solver(system_of(oscillator(0, 0)), {.guard = GuardPolicy::kRefuse});
  EXPECT_NO_THROW((void)solver.step(0.19));
  SpringSolver strict(system_of(oscillator(0, 0)), {.guard = GuardPolicy::kRefuse});
  try {
    (void)strict.step(0.25);
    FAIL() << "a step beyond 2 / w = 0.2 s was taken";
  } catch (const InvalidArgument& error) {
    EXPECT_NE(std::string(error.what()).find("0.25"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("0.2 [s]"), std::string::npos) << error.what();
  }
}

TEST(StepGuard, ReportsAnUnstableStepAndTakesIt) {
  SpringSolver solver(system_of(oscillator(0, 0)), {.guard = GuardPolicy::kReport});
  const StepOutcome outcome = solver.step(0.25);
  EXPECT_FALSE(outcome.is_step_stable);
  EXPECT_EQ(outcome.substeps, 1);
  EXPECT_NEAR(outcome.stable_step, 0.2, 1e-6 * 0.2);  // as kRayleighTolerance states
}

TEST(StepGuard, SubstepsAreTheFewestThatKeepTheSafety) {
  SpringSolver solver(system_of(oscillator(0, 0)), {.guard = GuardPolicy::kSubstep});
  const StepOutcome outcome = solver.step(0.5);
  EXPECT_EQ(outcome.substeps, 3);  // 0.5 / (0.9 x 0.2) = 2.8
  EXPECT_TRUE(outcome.is_step_stable);
  SpringSolver hopeless(system_of(oscillator(0, 0)), {.integrator = IntegratorKind::kExplicitEuler,
                                                      .guard = GuardPolicy::kSubstep});
  EXPECT_THROW((void)hopeless.step(0.01), InvalidArgument);
}

}  // namespace
}  // namespace weft::reference::testing
