// A mass on a spring with both dampers, against the exact solution of each integrator's own
// recurrence.
// Tested by tests/apps/command_line_test.sh, tests/apps/CMakeLists.txt.
#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include <Eigen/Core>

#include <weft/core/error.hpp>
#include <weft/validation/cases/support/analytic_cases.hpp>
#include <weft/validation/cases/support/parameters.hpp>
#include <weft/validation/cases/support/small_systems.hpp>

namespace weft::validation {
namespace oscillator {
namespace {

using reference::IntegratorKind;
using Matrix2 = Eigen::Matrix2d;  // acts on (x, v)

/// x'' = -(k / m) x - (c / m) x' - gamma x', and how it is stepped.
struct Oscillator {
  double mass = 0.3;             ///< [kg]
  double stiffness = 40.0;       ///< [N/m]
  double damping = 0.02;         ///< [N s/m]
  double rate = 0.05;            ///< [1/s]
  double time_step = 1.0 / 200;  ///< [s]: omega h = 0.06
  int steps = 1000;
};
constexpr double kLargestPhase = 0.5;       // w h, so that no method but explicit Euler grows
constexpr double kLargestGrowth = 3.0;      // of the amplitude
constexpr double kSmallestLeft = 1e-6;      // of it
constexpr double kStartDisplacement = 0.1;  // [m]
constexpr double kStartVelocity = 0.4;      // [m/s]

/// left^-1 right, by Cramer's rule.
Matrix2 solved(const Matrix2& left, const Matrix2& right) {
  const double determinant = left(0, 0) * left(1, 1) - left(0, 1) * left(1, 0);
  const Matrix2 adjoint{{left(1, 1), -left(0, 1)}, {-left(1, 0), left(0, 0)}};
  return adjoint * right / determinant;
}

/// One step of an integrator for x'' = -w^2 x - c x' - gamma x' as a matrix.
Matrix2 step_matrix(IntegratorKind integrator, const Oscillator& oscillator) {
  const double h = oscillator.time_step;
  const double w2 = oscillator.stiffness / oscillator.mass;
  const double c = oscillator.damping / oscillator.mass;
  const Matrix2 identity = Matrix2::Identity();
  const auto decay = [&](double time) {
    return Matrix2{{1, 0}, {0, std::exp(-oscillator.rate * time)}};
  };
  const Matrix2 continuous{{0, 1}, {-w2, -(c + oscillator.rate)}};
  switch (integrator) {
    case IntegratorKind::kExplicitEuler:
      return identity + h * continuous;
    case IntegratorKind::kModifiedEuler: {
      const Matrix2 kick{{1, 0}, {-h * w2, 1 - h * c}};
      const Matrix2 drift{{1, h}, {0, 1}};
      return decay(h) * drift * kick;
    }
    case IntegratorKind::kVelocityVerlet: {
      // a0 = A0 (x, u), x1 = x + h u + h^2/2 a0, a1 = -w2 x1 - c (u + h a0), v1 = u + h/2 (a0 + a1)
      const Eigen::RowVector2d a0(-w2, -c);
      const Eigen::RowVector2d x1 = Eigen::RowVector2d(1, h) + 0.5 * h * h * a0;
      const Eigen::RowVector2d a1 = -w2 * x1 - c * (Eigen::RowVector2d(0, 1) + h * a0);
      Matrix2 middle;
      middle << x1, Eigen::RowVector2d(0, 1) + 0.5 * h * (a0 + a1);
      return decay(h / 2) * middle * decay(h / 2);
    }
    case IntegratorKind::kYoshida4: {
      // Three steps of kick, drift, kick; a kick is an implicit midpoint rule in the velocity.
      Matrix2 step = identity;
      const double outer = 1 / (2 - std::cbrt(2.0));
      for (const double part : {outer, 1 - 2 * outer, outer}) {
        const double half = part * h / 2;
        const double drag = half * (c + oscillator.rate) / 2;
        const Matrix2 kick{{1, 0}, {-half * w2 / (1 + drag), (1 - drag) / (1 + drag)}};
        const Matrix2 drift{{1, 2 * half}, {0, 1}};
        step = kick * drift * kick * step;
      }
      return step;
    }
    case IntegratorKind::kImplicitEuler:
      return solved(identity - h * continuous, identity);
    case IntegratorKind::kImplicitMidpoint:
      return solved(identity - h / 2 * continuous, identity + h / 2 * continuous);
    case IntegratorKind::kTrBdf2: {
      // Trapezoid over a part of the step, then the backward formula through its start and its end.
      const double part = 2 - std::sqrt(2.0);
      const Matrix2 left = identity - part / 2 * h * continuous;
      const Matrix2 middle = solved(left, identity + part / 2 * h * continuous);
      const double old = (1 - part) * (1 - part);
      return solved(left, (middle - old * identity) / (part * (2 - part)));
    }
    default:  // Runge-Kutta 4; no other is asked for here
      break;
  }
  const Matrix2 z = h * continuous;
  return identity + z * (identity + z / 2 * (identity + z / 3 * (identity + z / 4)));
}

/// Powers by squaring: another order of operations than the solver's, so that a common mistake
/// cannot hide.
Matrix2 power(Matrix2 base, int exponent) {
  Matrix2 result = Matrix2::Identity();
  for (; exponent > 0; exponent /= 2) {
    if (exponent % 2 == 1) result = result * base;
    base = base * base;
  }
  return result;
}

/// (x, v / w) at the end over that at the start, by the recurrence [-].
double amplitude_left(IntegratorKind integrator, const Oscillator& oscillator) {
  const double frequency = std::sqrt(oscillator.stiffness / oscillator.mass);
  const Eigen::Vector2d start(kStartDisplacement, kStartVelocity);
  const Eigen::Vector2d end = power(step_matrix(integrator, oscillator), oscillator.steps) * start;
  return std::hypot(end[0], end[1] / frequency) / std::hypot(start[0], start[1] / frequency);
}

struct Mistake {
  double stiffness_factor = 1.0;
  bool flip_damping = false;
  int dropped_steps = 0;
  bool unset_velocity = false;
};

/// Relative error of (x, v / w) after all steps, against the matrix power.
double measure(IntegratorKind integrator, const Oscillator& oscillator, const Mistake& mistake) {
  SpringRow row;
  row.mass = oscillator.mass;
  row.laws = {tension_law(oscillator.stiffness * mistake.stiffness_factor),
              spring_damping_law(oscillator.damping), velocity_damping_law(oscillator.rate)};
  row.flip_damping = mistake.flip_damping;
  reference::Body body = make_row(row);
  body.positions(0, 1) += kStartDisplacement;
  body.velocities(0, 1) = mistake.unset_velocity ? 0.0 : kStartVelocity;
  reference::SpringSolver solver = make_solver(std::move(body), integrator);
  for (int step = 0; step < oscillator.steps - mistake.dropped_steps; ++step) {
    (void)solver.step(oscillator.time_step);
  }
  const reference::Body& end = solver.system().bodies[0];
  const Eigen::Vector2d exact = power(step_matrix(integrator, oscillator), oscillator.steps) *
                                Eigen::Vector2d(kStartDisplacement, kStartVelocity);
  const double frequency = std::sqrt(oscillator.stiffness / oscillator.mass);
  const double scale = std::hypot(exact[0], exact[1] / frequency);
  return std::hypot(end.positions(0, 1) - row.spacing - exact[0],
                    (end.velocities(0, 1) - exact[1]) / frequency) /
         scale;
}

constexpr std::array kParameters = {
    CaseParameter{"mass", "kg", "of the mass", 1e-3, 1e3, 0.3},
    CaseParameter{"stiffness", "N/m", "of the spring", 0.1, 1e4, 40.0},
    CaseParameter{"damping", "N s/m", "of the spring's damper", 0.0, 0.1, 0.02},
    CaseParameter{"rate", "1/s", "of velocity_damping", 0.0, 2.0, 0.05},
    CaseParameter{"time-step", "s", "times sqrt(stiffness / mass) at most 0.5", 1e-5, 1.0, 0.005},
    CaseParameter{"steps", "1", "number of them", 10, 1000, 1000.0, true},
};

}  // namespace
}  // namespace oscillator

std::span<const CaseParameter> oscillator_parameters() {
  using namespace oscillator;
  return kParameters;
}

void evaluate_oscillator(const CaseInfo& info, const CaseOptions& options, const EngineRuns&,
                         Report& report) {
  using namespace oscillator;
  Oscillator oscillator;
  if (asks_for_point(options)) {
    const auto value = [&](const char* name) { return value_of(info, options, name); };
    oscillator = {value("mass"), value("stiffness"), value("damping"),
                  value("rate"), value("time-step"), static_cast<int>(value("steps"))};
    const double phase = oscillator.time_step * std::sqrt(oscillator.stiffness / oscillator.mass);
    if (!(phase <= kLargestPhase)) {
      throw InvalidArgument("validate: case 'oscillator': time-step sqrt(stiffness / mass) = " +
                            std::to_string(phase) + " [1], expected at most " +
                            std::to_string(kLargestPhase));
    }
  }
  const double decay = oscillator.rate + oscillator.damping / oscillator.mass;
  for (const IntegratorKind integrator :
       {IntegratorKind::kExplicitEuler, IntegratorKind::kModifiedEuler,
        IntegratorKind::kVelocityVerlet, IntegratorKind::kRungeKutta4, IntegratorKind::kYoshida4,
        IntegratorKind::kImplicitEuler, IntegratorKind::kImplicitMidpoint,
        IntegratorKind::kTrBdf2}) {
    // Roundings are measured against what is left of the amplitude. Where nothing is left, or the mass would
    // swing through its pivot, there is nothing to compare.
    const double left = amplitude_left(integrator, oscillator);
    if (left < kSmallestLeft || left > kLargestGrowth) continue;
    const Tolerance tolerance{
        2e-12 / std::min(1.0, left), Basis::kRoundoff,
        "up to 1000 steps, each with a rounding of 1e-16 of the spring's "
        "length, 10 times the displacement; a wrong term shows at 1e-4 and above"};
    CheckResult check;
    check.case_id = info.id;
    check.engine = "reference";
    check.claim = std::string(name_of(integrator)) +
                  " steps a damped oscillator exactly as its own recurrence says";
    check.metric = "relative error of position and velocity after " +
                   std::to_string(oscillator.steps) + " steps";
    check.unit = "1";
    check.formula = "(x, v)_n = M^n (x, v)_0";
    check.source = "2 x 2 matrix of one step of the scheme, raised to the power n";
    check.measured = measure(integrator, oscillator, {});
    check.tolerance = tolerance;
    check.note = "a force, its sign, or the order of operations within the step";
    const auto add = [&](const char* name, const Mistake& mistake) {
      const double measured = measure(integrator, oscillator, mistake);
      check.sabotages.push_back({name, measured, judge(measured, tolerance) == Verdict::kFail});
    };
    add("spring constant +1 %", {.stiffness_factor = 1.01});
    if (decay > 0) add("sign of the damping", {.flip_damping = true});
    add("one step dropped", {.dropped_steps = 1});
    add("initial velocity unset", {.unset_velocity = true});
    check.verdict = judge(check.measured, tolerance);
    report.checks.push_back(std::move(check));
  }
}

}  // namespace weft::validation
