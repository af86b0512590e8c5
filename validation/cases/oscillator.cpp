// A mass on a spring with both dampers, against the exact solution of each integrator's own
// recurrence.
#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include <Eigen/Core>

#include <weft/custom_forces/core/error.hpp>
#include <weft/validation/cases/analytic_cases.hpp>
#include <weft/validation/cases/parameters.hpp>
#include <weft/validation/cases/small_systems.hpp>

namespace weft::validation {
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
constexpr double kLargestPhase = 1.4;       // w h, so that no method but explicit Euler grows
constexpr double kStartDisplacement = 0.1;  // [m]
constexpr double kStartVelocity = 0.4;      // [m/s]

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
    default:  // only the four of kIntegrators are asked for here
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
    CaseParameter{"time-step", "s", "w h must be below 1.4", 1e-5, 1.0, 0.005},
    CaseParameter{"steps", "1", "number of them", 10, 1000, 1000.0, true},
};

}  // namespace

std::span<const CaseParameter> oscillator_parameters() {
  return kParameters;
}

void evaluate_oscillator(const CaseInfo& info, const CaseOptions& options, const EngineRuns&,
                         Report& report) {
  Oscillator oscillator;
  if (asks_for_point(options)) {
    const auto value = [&](const char* name) { return value_of(info, options, name); };
    oscillator = {value("mass"), value("stiffness"), value("damping"),
                  value("rate"), value("time-step"), static_cast<int>(value("steps"))};
  }
  // What is left of the amplitude at the end is what roundings are measured against.
  const double decay = oscillator.rate + oscillator.damping / oscillator.mass;
  const double left = std::exp(-decay / 2 * oscillator.time_step * oscillator.steps);
  const Tolerance tolerance{
      std::min(2e-12 / left, 1e-4), Basis::kRoundoff,
      "up to 1000 steps, each with a rounding of 1e-16 of the spring's length, 10 "
      "times the displacement; a wrong term shows at 1e-4 and above"};
  for (const IntegratorKind integrator :
       {IntegratorKind::kExplicitEuler, IntegratorKind::kModifiedEuler,
        IntegratorKind::kVelocityVerlet, IntegratorKind::kRungeKutta4}) {
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
