// Two masses on a damped spring spin for ever: internal damping must not feel a rigid rotation.
// Tested by tests/apps/CMakeLists.txt.
#include <cmath>
#include <complex>
#include <numbers>

#include <weft/validation/cases/support/analytic_cases.hpp>
#include <weft/validation/cases/support/closed_form_check.hpp>
#include <weft/validation/cases/support/small_systems.hpp>

namespace weft::validation {
namespace spinning_dumbbell {
namespace {

constexpr double kLength = 0.5;      // l0 [m]
constexpr double kStiffness = 50.0;  // k [N/m]
constexpr double kDamping = 0.2;     // c [N s/m]
constexpr double kLight = 0.1;       // [kg]
constexpr double kHeavy = 0.4;       // [kg]
constexpr int kStepsPerTurn = 100;
constexpr int kTurns = 1000;
constexpr double kSpin = 8.0;  // W = 2 sin(p / 2) / h [rad/s], p the angle per step

double step_angle() {
  return 2 * std::numbers::pi / kStepsPerTurn;
}
double time_step() {
  return 2 * std::sin(step_angle() / 2) / kSpin;
}

/// Steady length of modified Euler: k (l - l0) + c l h W^2 / 2 = mu W^2 l, for the velocity it takes has a part
/// along the spring.
double steady_length(double damping) {
  const double reduced = kLight * kHeavy / (kLight + kHeavy);
  return kStiffness * kLength /
         (kStiffness + damping * time_step() * kSpin * kSpin / 2 - reduced * kSpin * kSpin);
}

/// Largest relative change of the length and of the angular momentum at full turns.
double change(double length, const std::vector<forces::LawSpecification>& laws, int turns) {
  SpringBody springs;
  springs.positions = Matrix3X<double>::Zero(3, 2);
  springs.positions(0, 1) = kLength;
  springs.edges.resize(2, 1);
  springs.edges << 0, 1;
  springs.masses.resize(2);
  springs.masses << kLight, kHeavy;
  springs.laws = laws;
  reference::Body body = make_body(springs);
  const double h = time_step();
  const std::complex<double> back = std::polar(1.0, -step_angle());
  const double light_arm = -length * kHeavy / (kLight + kHeavy);
  for (int i = 0; i < 2; ++i) {
    const std::complex<double> x = i == 0 ? light_arm : light_arm + length;
    const std::complex<double> v = (x - x * back) / h;
    body.positions.col(i) << x.real(), x.imag(), 0;
    body.velocities.col(i) << v.real(), v.imag(), 0;
  }
  reference::SpringSolver solver =
      make_solver(std::move(body), reference::IntegratorKind::kModifiedEuler);
  const auto spin = [&] {
    const reference::Body& now = solver.system().bodies[0];
    double sum = 0;
    for (int i = 0; i < 2; ++i) {
      const Vector3<double> x = now.positions.col(i);
      sum += now.mesh.masses[i] * x.cross(Vector3<double>(now.velocities.col(i))).z();
    }
    return sum;
  };
  const double start = spin();
  double largest = 0;
  for (int step = 1; step <= turns * kStepsPerTurn; ++step) {
    if (solver.step(h).blow_up) return std::nan("");
    if (step % kStepsPerTurn != 0) continue;
    const Matrix3X<double>& x = solver.system().bodies[0].positions;
    largest = std::max({largest, std::abs((x.col(1) - x.col(0)).norm() / length - 1),
                        std::abs(spin() / start - 1)});
  }
  return largest;
}

}  // namespace
}  // namespace spinning_dumbbell

void evaluate_spinning_dumbbell(const CaseInfo& info, const CaseOptions&, const EngineRuns&,
                                Report& report) {
  using namespace spinning_dumbbell;
  const std::vector<forces::LawSpecification> laws = {
      tension_law(kStiffness), spring_damping_law(kDamping), torsional_rotation_damping_law(2.0)};
  CheckResult check = judged(
      info,
      {"a spinning dumbbell with spring and torsional rotation damping on keeps length and spin",
       "largest relative change of length or angular momentum, 1000 turns",
       "k (l - l0) + c l h W^2 / 2 = mu W^2 l, W = 2 sin(p / 2) / h",
       "steady state of modified Euler with the angle p per step; h -> 0: k (l - l0) = mu w^2 l",
       {5e-13, Basis::kRoundoff, "1e5 steps, each with a rounding of 1e-16 up or down"},
       "a damper that acts on rigid rotation"},
      change(steady_length(kDamping), laws, kTurns));
  auto with_rotation_damping = laws;
  with_rotation_damping.push_back(rotation_damping_law(1e-6));
  constexpr int kFewTurns = 20;
  add_sabotage(check, "rotation_damping of 1e-6 1/s on, 20 turns",
               change(steady_length(kDamping), with_rotation_damping, kFewTurns));
  add_sabotage(check, "length without the damper's part, 20 turns",
               change(steady_length(0), laws, kFewTurns));
  report.checks.push_back(std::move(check));
}

}  // namespace weft::validation
