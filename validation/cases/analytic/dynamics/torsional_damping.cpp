#include <weft/validation/cases/analytic/dynamics/torsional_damping.hpp>

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include <weft/validation/cases/support/closed_form_check.hpp>
#include <weft/validation/cases/support/small_systems.hpp>

namespace weft::validation {
namespace torsional_damping {
namespace {

using reference::IntegratorKind;

const double kPi = std::acos(-1.0);

// Two rings of 6 masses, each inner mass tied to the two outer ones beside the one in front of it.
namespace twist {

constexpr int kSize = 6;
constexpr double kInner = 0.5, kOuter = 1.0;          // radii [m]
constexpr double kInnerMass = 0.3, kOuterMass = 0.1;  // [kg]
constexpr double kStiffness = 50.0;                   // [N/m]
constexpr double kRate = 0.6;                         // [1/s]
constexpr double kTimeStep = 5e-3;                    // [s]: omega h = 0.1
constexpr int kNumSteps = 1000;                       // three time constants of the amplitude / 2
constexpr double kAngle = 1e-6;                       // [rad]

SpringBody rings() {
  SpringBody body;
  body.positions = Matrix3X<double>::Zero(3, 2 * kSize);
  body.masses.resize(2 * kSize);
  body.edges.resize(2, 4 * kSize);
  for (int i = 0; i < kSize; ++i) {
    const Vector3<double> e(std::cos(2 * kPi * i / kSize), std::sin(2 * kPi * i / kSize), 0);
    body.positions.col(i) = kInner * e;
    body.positions.col(kSize + i) = kOuter * e;
    body.masses[i] = kInnerMass;
    body.masses[kSize + i] = kOuterMass;
    const int next = (i + 1) % kSize;
    const int previous = (i + kSize - 1) % kSize;
    body.edges.col(4 * i) << i, kSize + next;
    body.edges.col(4 * i + 1) << i, kSize + previous;
    body.edges.col(4 * i + 2) << std::min(i, next), std::max(i, next);
    body.edges.col(4 * i + 3) << kSize + std::min(i, next), kSize + std::max(i, next);
  }
  return body;
}

/// Angle of the outer ring against the inner one [rad], and its rate times the step.
Eigen::Vector2d twist_of(const reference::Body& body) {
  Eigen::Vector2d sum(0, 0);
  for (int i = 0; i < 2 * kSize; ++i) {
    const bool outer = i >= kSize;
    const double sign = outer ? 1.0 : -1.0;
    const double radius = outer ? kOuter : kInner;
    const Vector3<double> e = body.mesh.rest_positions.col(i) / radius;
    const Vector3<double> t(-e.y(), e.x(), 0);
    sum[0] += sign * t.dot(body.positions.col(i)) / radius;
    sum[1] += sign * t.dot(body.velocities.col(i)) / radius;
  }
  return sum / kSize;
}

/// omega^2 [rad^2/s^2]: stretch of a tie per angle a b sin(60 deg) / l, two ties for each pair of
/// masses, whose moments of inertia act in series.
double squared_frequency() {
  const double sine = std::sin(2 * kPi / kSize);
  const double cosine = std::cos(2 * kPi / kSize);
  const double squared_length = kInner * kInner + kOuter * kOuter - 2 * kInner * kOuter * cosine;
  const double lever = kInner * kOuter * sine;
  const double inner = kInnerMass * kInner * kInner;
  const double outer = kOuterMass * kOuter * kOuter;
  return 2 * kStiffness * lever * lever / squared_length * (inner + outer) / (inner * outer);
}

/// Relative error of angle and rate after kNumSteps against the recurrence of modified Euler.
double error(const std::vector<forces::LawSpecification>& damping, bool flip) {
  SpringBody springs = rings();
  springs.laws = damping;
  springs.laws.push_back(tension_law(kStiffness));
  springs.flip_damping = flip;
  reference::Body body = make_body(springs);
  const double inner = kInnerMass * kInner * kInner;
  const double outer = kOuterMass * kOuter * kOuter;
  for (int i = 0; i < 2 * kSize; ++i) {
    const double share = i >= kSize ? inner : -outer;  // L = 0
    const Vector3<double> x = body.positions.col(i);
    body.positions.col(i) += kAngle * share / (inner + outer) * Vector3<double>(-x.y(), x.x(), 0);
  }
  reference::SpringSolver solver = make_solver(std::move(body), IntegratorKind::kModifiedEuler);
  for (int step = 0; step < kNumSteps; ++step) (void)solver.step(kTimeStep);

  const double w2 = squared_frequency();
  Eigen::Vector2d exact(kAngle, 0);
  for (int step = 0; step < kNumSteps; ++step) {
    exact[1] -= kTimeStep * w2 * exact[0];
    exact[0] += kTimeStep * exact[1];
    exact[1] *= std::exp(-kRate * kTimeStep);
  }
  const Eigen::Vector2d found = twist_of(solver.system().bodies[0]);
  const Eigen::Vector2d scale(1, 1 / std::sqrt(w2));
  return (found - exact).cwiseProduct(scale).norm() / exact.cwiseProduct(scale).norm();
}

}  // namespace twist

// A ring of masses on springs that spins about its axis, with every internal damping on.
//
// Modified Euler: x_(n+1) - 2 x_n + x_(n-1) = h^2 a_n, v_n = (x_n - x_(n-1)) / h. On a circle with
// the angle p per step the left side is -2 (1 - cos p) x_n = -h^2 W^2 x_n, W = 2 sin(p/2) / h. The
// velocity v_n has, besides the rigid spin, the same outward part (1 - cos p) / h r = h W^2 r / 2 at
// every mass; the dampers along the springs feel it. With tension and damper, s = sin(pi / N),
//
//   (1 + beta) m W^2 r = 2 s (k (2 s r - l0) + c s h W^2 r)
//   r = 2 k l0 s / (4 k s^2 + 2 c s^2 h W^2 - (1 + beta) m W^2),
//
// for c = beta = 0, h -> 0 the well-known 2 k l0 s / (4 k s^2 - m w^2). The swirl of v_n is 0.
namespace ring {

constexpr int kSize = 12;
constexpr double kMass = 0.05;       // [kg]
constexpr double kStiffness = 200;   // [N/m]
constexpr double kDamping = 0.1;     // [N s/m]
constexpr double kRate = 2.0;        // of the swirl [1/s]
constexpr double kBeta = 1.0;        // [-]
constexpr double kDiscreteSpin = 8;  // W [rad/s]
constexpr int kStepsPerTurn = 100;
constexpr int kTurns = 1000;
constexpr int kFewTurns = 20;  // enough for a mistake to show

double side() {
  return std::sin(kPi / kSize);
}
double angle() {
  return 2 * kPi / kStepsPerTurn;
}
double time_step() {
  return 2 * std::sin(angle() / 2) / kDiscreteSpin;
}
double rest_length() {
  return 2 * side();
}  // rest radius 1 m

/// m = (1 + beta) m as the ring feels it [kg], c the damping [N s/m].
double radius(double mass, double damping) {
  const double w2 = kDiscreteSpin * kDiscreteSpin;
  const double s = side();
  return 2 * kStiffness * rest_length() * s /
         (4 * kStiffness * s * s + 2 * damping * s * s * time_step() * w2 - mass * w2);
}

std::vector<forces::LawSpecification> internal_laws() {
  return {tension_law(kStiffness), spring_damping_law(kDamping),
          torsional_rotation_damping_law(kRate), acceleration_damping_law(kBeta)};
}

SpringBody resting(const std::vector<forces::LawSpecification>& laws) {
  SpringBody body;
  body.positions = Matrix3X<double>::Zero(3, kSize);
  body.edges.resize(2, kSize);
  body.masses = VectorX<double>::Constant(kSize, kMass);
  body.laws = laws;
  for (int i = 0; i < kSize; ++i) {
    body.positions.col(i) << std::cos(2 * kPi * i / kSize), std::sin(2 * kPi * i / kSize), 0;
    const int next = (i + 1) % kSize;
    body.edges.col(i) << std::min(i, next), std::max(i, next);
  }
  return body;
}

/// Largest relative change of the radius of any mass, and of its angular velocity, at full turns.
double change(const std::vector<forces::LawSpecification>& laws, double start_radius, int turns) {
  reference::Body body = make_body(resting(laws));
  const double h = time_step();
  const std::complex<double> before = std::polar(1.0, -angle());
  for (int i = 0; i < kSize; ++i) {
    const std::complex<double> x =
        start_radius * std::complex<double>(body.positions(0, i), body.positions(1, i));
    const std::complex<double> v = (x - x * before) / h;
    body.positions.col(i) << x.real(), x.imag(), 0;
    body.velocities.col(i) << v.real(), v.imag(), 0;
  }
  reference::SpringSolver solver = make_solver(std::move(body), IntegratorKind::kModifiedEuler);
  const reference::Body& now = solver.system().bodies[0];
  const double spin = std::sin(angle()) / h;
  double worst = 0;
  for (int step = 1; step <= turns * kStepsPerTurn; ++step) {
    if (solver.step(h).blow_up) return std::numeric_limits<double>::infinity();
    if (step % kStepsPerTurn != 0) continue;
    for (int i = 0; i < kSize; ++i) {
      const Vector3<double> x = now.positions.col(i);
      const Vector3<double> v = now.velocities.col(i);
      worst = std::max({worst, std::abs(x.norm() / start_radius - 1),
                        std::abs(x.cross(v).z() / (x.squaredNorm() * spin) - 1)});
    }
  }
  return worst;
}

}  // namespace ring

}  // namespace
}  // namespace torsional_damping

void check_torsional_mode(const CaseInfo& info, Report& report) {
  using namespace torsional_damping;
  const std::vector<forces::LawSpecification> right = {
      torsional_rotation_damping_law(twist::kRate)};
  CheckResult check = judged(
      info,
      {"two rings that twist against each other come to rest at the stated rate",
       "relative error of angle and rate after 1000 steps",
       "v <- exp(-h rate) (v - h w^2 x), w^2 = 2 k (a b sin 60 deg / l)^2 (1 / J_a + 1 / J_b)",
       "recurrence of modified Euler for the mode with L = 0",
       {1e-6, Basis::kTruncation,
        "angle of 1e-6 rad: rounding of positions 1e-10 of it per step, what is not linear 1e-12"},
       "the projector, or the place of the law in the step"},
      twist::error(right, false));
  add_sabotage(check, "rate +1 %",
               twist::error({torsional_rotation_damping_law(1.01 * twist::kRate)}, false));
  add_sabotage(check, "sign of the damping", twist::error(right, true));
  add_sabotage(check, "rotation_damping instead",
               twist::error({rotation_damping_law(twist::kRate)}, false));
  report.checks.push_back(std::move(check));
}

void check_spinning_ring(const CaseInfo& info, Report& report) {
  using namespace torsional_damping;
  const double radius = ring::radius((1 + ring::kBeta) * ring::kMass, ring::kDamping);
  CheckResult check = judged(
      info,
      {"a spinning ring with spring, torsional rotation and acceleration damping on keeps radius "
       "and spin over 1000 turns",
       "largest relative change of a mass's radius or angular velocity",
       "r = 2 k l0 s / (4 k s^2 + 2 c s^2 h W^2 - (1 + beta) m W^2), s = sin(pi / N), W = 2 sin(p "
       "/ "
       "2) / h",
       "steady state of modified Euler with the angle p per step; h -> 0, beta = 0: 2 k l0 s / (4 "
       "k "
       "s^2 - m w^2)",
       {1e-8, Basis::kRoundoff, "1e5 steps, each with a rounding of 1e-15"},
       "a damper that acts on rigid rotation"},
      ring::change(ring::internal_laws(), radius, ring::kTurns));
  auto with_rotation_damping = ring::internal_laws();
  with_rotation_damping.push_back(rotation_damping_law(1e-6));
  add_sabotage(check, "rotation_damping of 1e-6 1/s on, 20 turns",
               ring::change(with_rotation_damping, radius, ring::kFewTurns));
  add_sabotage(check, "radius of a ring without added inertia, 20 turns",
               ring::change(ring::internal_laws(), ring::radius(ring::kMass, ring::kDamping),
                            ring::kFewTurns));
  add_sabotage(check, "radius without the dampers' part, 20 turns",
               ring::change(ring::internal_laws(), ring::radius((1 + ring::kBeta) * ring::kMass, 0),
                            ring::kFewTurns));
  report.checks.push_back(std::move(check));
}

}  // namespace weft::validation
