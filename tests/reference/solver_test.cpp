#include <cmath>

#include <gtest/gtest.h>

#include <weft/core/error.hpp>
#include <weft/core/parallel/threads.hpp>
#include <weft/reference/balance.hpp>

#include "tests/reference/small_systems.hpp"

namespace weft::reference::testing {
namespace {

constexpr double kGravity = 9.81;  // [m/s^2]

TEST(HangingChain, ComesToRestAtTheClosedFormTipDrop) {
  constexpr int kMasses = 8;
  constexpr double kMass = 0.1, kStiffness = 200.0, kSpacing = 0.5;
  const double drop = kMass * kGravity * kMasses * (kMasses + 1) / (2 * kStiffness);
  for (const IntegratorKind integrator : kAllIntegrators) {
    Body body = make_chain(kMasses + 1, kSpacing, kMass, kStiffness);
    body.mesh.pinned = {0};
    add_law(body, "gravity", {{"acceleration", {kGravity, 0, 0}}});  // along the chain
    add_law(body, "velocity_damping", {{"rate", {10.0}}});
    SpringSolver solver = solver_of(std::move(body), integrator);
    // The slowest mode, 2 sqrt(k/m) sin(pi / 34) = 8.2 rad/s, decays with 5 / s: exp(-5 x 8) =
    // 4e-18.
    // 0.0004 s: explicit Euler needs h well below gamma / w^2 = 10 / 8000 s.
    while (solver.time() < 8.0) ASSERT_FALSE(solver.step(0.0004).blow_up);
    const double tip = solver.system().bodies[0].positions(0, kMasses) - kMasses * kSpacing;
    EXPECT_NEAR(tip, drop, 1e-10 * drop) << name_of(integrator);  // round-off of a 4 m coordinate
  }
}

Body pinned_lattice() {
  Body body = make_cloth(7, 1.0, 0.2, 0.0, 50.0, 0.0);
  body.mesh.pinned = {0, 6};
  add_law(body, "gravity", {{"acceleration", {0, -kGravity, 0}}});
  return body;
}

/// A step at which modified Euler is stable with a margin for stretched springs [s].
double good_step() {
  System system = system_of(pinned_lattice());
  return 0.7 * assess(system, IntegratorKind::kModifiedEuler).stable_step;
}

TEST(ExplicitEuler, ExplodesOnAnUndampedLatticeAndSaysWhere) {
  SpringSolver solver = solver_of(pinned_lattice(), IntegratorKind::kExplicitEuler);
  const double step = good_step();
  StepOutcome outcome;
  int steps = 0;
  for (; steps < 2000 && !outcome.blow_up; ++steps) outcome = solver.step(step);
  ASSERT_TRUE(outcome.blow_up);
  EXPECT_EQ(outcome.blow_up->body, "cloth");
  EXPECT_FALSE(outcome.blow_up->reason.empty());
  EXPECT_GE(outcome.blow_up->node, 0);
  EXPECT_LT(outcome.blow_up->node, 49);

  const double time = solver.time();
  const Matrix3X<double> positions = solver.system().bodies[0].positions;
  EXPECT_TRUE(solver.step(step).blow_up);
  EXPECT_EQ(solver.time(), time);
  EXPECT_TRUE(positions.cwiseEqual(solver.system().bodies[0].positions).all());
}

TEST(ModifiedEuler, SurvivesWhereExplicitEulerExplodes) {
  SpringSolver solver = solver_of(pinned_lattice(), IntegratorKind::kModifiedEuler);
  const double step = good_step();
  for (int n = 0; n < 5000; ++n) ASSERT_FALSE(solver.step(step).blow_up);
  EXPECT_LT(solver.system().bodies[0].velocities.cwiseAbs().maxCoeff(), 100.0);
}

TEST(BlowUp, AStateThatIsNotFiniteIsDataToo) {
  Body body = make_chain(3, 1.0, 1.0, 1.0);
  body.positions(1, 2) = std::numeric_limits<double>::quiet_NaN();
  SpringSolver solver = solver_of(std::move(body), IntegratorKind::kModifiedEuler);
  const StepOutcome outcome = solver.step(0.01);
  ASSERT_TRUE(outcome.blow_up);
  EXPECT_EQ(outcome.blow_up->node, 2);
  EXPECT_EQ(outcome.blow_up->reason, "position is not finite");
}

TEST(PinnedNodes, DoNotMove) {
  for (const IntegratorKind integrator : kAllIntegrators) {
    Body body = make_cloth(5, 1.0, 0.2, 0.0, 50.0, 0.1);
    body.mesh.pinned = {0, 12};
    body.velocities.setConstant(0.3);
    add_law(body, "gravity", {{"acceleration", {0, -kGravity, 0}}});
    add_law(body, "velocity_damping", {{"rate", {2.0}}});
    const Matrix3X<double> start = body.positions;
    SpringSolver solver = solver_of(std::move(body), integrator);
    for (int n = 0; n < 20; ++n) (void)solver.step(0.002);
    for (const int node : {0, 12}) {
      EXPECT_EQ(solver.system().bodies[0].positions.col(node), start.col(node));
      EXPECT_TRUE(solver.system().bodies[0].velocities.col(node).isZero(0.0));
    }
    EXPECT_NE(solver.system().bodies[0].positions.col(24), start.col(24));
  }
}

TEST(Energy, IsKeptByVerletAndItsLossIsThePowerOfTheDampers) {
  // Ledger of a damped stretch: d(KE + PE)/dt = power, summed with the trapezoid rule.
  const auto ledger_error = [](double step) {
    Body body = make_cloth(5, 1.0, 0.2, 0.0, 50.0, 0.05);
    body.positions *= 1.1;
    SpringSolver solver = solver_of(std::move(body), IntegratorKind::kVelocityVerlet);
    const double start = energies(solver.system()).total();
    double lost = 0.0;
    for (int n = 0; n < std::lround(0.2 / step); ++n) {
      const double before = energies(solver.system()).power;
      (void)solver.step(step);
      lost += 0.5 * step * (before + energies(solver.system()).power);
    }
    EXPECT_LT(lost, -0.05 * start);  // enough was lost to mean something
    return std::abs(energies(solver.system()).total() - start - lost) / start;
  };
  const double coarse = ledger_error(0.0005);
  const double fine = ledger_error(0.00025);
  EXPECT_LT(coarse, 0.01);        // truncation: (h w)^2 / 24 of the stiffest modes
  EXPECT_GT(coarse / fine, 3.0);  // order 2: four
}

TEST(Momentum, OfAFreeClothIsConservedToRoundOff) {
  Body body = make_cloth(7, 1.0, 0.2, 0.3, 50.0, 0.05);
  for (Eigen::Index i = 0; i < body.velocities.cols(); ++i) {
    body.velocities.col(i) << std::sin(1.0 * i), std::cos(2.0 * i), std::sin(3.0 * i);
  }
  for (const IntegratorKind integrator :
       {IntegratorKind::kModifiedEuler, IntegratorKind::kVelocityVerlet}) {
    Body copy = make_cloth(7, 1.0, 0.2, 0.3, 50.0, 0.05);
    copy.velocities = body.velocities;
    SpringSolver solver = solver_of(std::move(copy), integrator);
    const Vector3<double> linear = linear_momentum(solver.system());
    const Vector3<double> angular = angular_momentum(solver.system());
    for (int n = 0; n < 500; ++n) (void)solver.step(0.002);
    constexpr double kRoundOff = 1e-13;  // 500 steps of sums of size 0.1
    EXPECT_LT((linear_momentum(solver.system()) - linear).norm(), kRoundOff);
    EXPECT_LT((angular_momentum(solver.system()) - angular).norm(), kRoundOff);
  }
}

TEST(Bodies, DoNotInfluenceEachOtherWithoutContact) {
  const auto cloth = [](double height) {
    Body body = make_cloth(4, 1.0, 0.2, height, 50.0, 0.05);
    body.positions.row(0) *= 1.1;
    return body;
  };
  System both;
  both.bodies.push_back(cloth(0.0));
  both.bodies.push_back(cloth(1.0));
  SpringSolver pair(std::move(both));
  SpringSolver alone = solver_of(cloth(1.0), IntegratorKind::kModifiedEuler);
  for (int n = 0; n < 50; ++n) {
    (void)pair.step(0.002);
    (void)alone.step(0.002);
  }
  EXPECT_EQ(pair.system().bodies[1].positions, alone.system().bodies[0].positions);
}

Matrix3X<double> drape(IntegratorKind integrator) {
  Body cloth = make_cloth(30, 1.0, 0.4, 0.25, 100.0, 0.02);
  add_law(cloth, "gravity", {{"acceleration", {0, -kGravity, 0}}});
  cloth.collision_margin = 0.01;
  cloth.friction = 0.4;
  System system = system_of(std::move(cloth));
  system.gravity = {0, -kGravity, 0};
  Collider ball{.name = "ball", .shape = Sphere{0.2}};
  ball.mass = 5.0;
  system.colliders.push_back(ball);
  SpringSolver solver(std::move(system), {.integrator = integrator});
  for (int n = 0; n < 100; ++n) (void)solver.step(0.001);
  Matrix3X<double> all(3, 1801);
  all << solver.system().bodies[0].positions, solver.system().bodies[0].velocities,
      solver.system().colliders[0].angular_velocity;
  return all;
}

Matrix3X<double> drape_on(int num_threads, IntegratorKind integrator) {
  return with_threads(num_threads, [&] { return drape(integrator); });
}

TEST(Determinism, TheSameBitsForOneTwoAndFourThreads) {
  for (const IntegratorKind integrator :
       {IntegratorKind::kModifiedEuler, IntegratorKind::kRungeKutta4}) {
    const Matrix3X<double> one = drape_on(1, integrator);
    EXPECT_TRUE(one.allFinite());
    EXPECT_EQ(one, drape_on(2, integrator));
    EXPECT_EQ(one, drape_on(4, integrator));
  }
}

void expect_refused(System system, const std::string& named) {
  try {
    SpringSolver solver(std::move(system));
    FAIL() << "accepted a bad " << named;
  } catch (const InvalidArgument& error) {
    EXPECT_NE(std::string(error.what()).find(named), std::string::npos) << error.what();
  }
}

TEST(SpringSolver, RefusesBadInputByName) {
  const auto good = [] { return system_of(make_chain(3, 1.0, 1.0, 1.0)); };
  System system = good();
  system.bodies[0].positions.resize(3, 2);
  expect_refused(std::move(system), "positions.cols()");
  system = good();
  system.bodies[0].mesh.masses[1] = 0.0;
  expect_refused(std::move(system), "mass of node 1 [kg]");
  system = good();
  system.bodies[0].mesh.pinned = {3};
  expect_refused(std::move(system), "pinned node");
  system = good();
  system.bodies[0].collision_margin = -0.1;
  expect_refused(std::move(system), "collision_margin [m]");
  system = good();
  system.colliders.push_back({.name = "ball", .shape = Sphere{0.0}});
  expect_refused(std::move(system), "radius [m]");
  system = good();
  system.colliders.push_back({.name = "floor", .shape = Plane{}});
  system.colliders[0].mass = 1.0;
  expect_refused(std::move(system), "mass [kg]");
  system = good();
  system.colliders.push_back({.name = "box", .shape = Box{{1, 1, 1}}});
  system.colliders[0].orientation.coeffs().setZero();
  expect_refused(std::move(system), "orientation");
}

TEST(SpringSolver, RefusesAStepThatIsNotPositive) {
  SpringSolver solver = solver_of(make_chain(3, 1.0, 1.0, 1.0), IntegratorKind::kModifiedEuler);
  for (const double step : {0.0, -0.1, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_THROW((void)solver.step(step), InvalidArgument);
  }
}

}  // namespace
}  // namespace weft::reference::testing
