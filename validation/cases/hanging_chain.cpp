// Masses on springs, one below the other: the tip drops by m g N (N + 1) / (2 k), for every N.
#include <cmath>

#include <weft/validation/cases/analytic_cases.hpp>
#include <weft/validation/cases/small_systems.hpp>

namespace weft::validation {
namespace {

constexpr double kMass = 0.1;          // [kg]
constexpr double kStiffness = 1000.0;  // [N/m]
constexpr double kGravity = 9.81;      // [m/s^2]
constexpr double kTimeStep = 1e-3;     // [s]: a tenth of the stable step 2 / (2 sqrt(k / m))
constexpr double kEndTime = 12.0;  // [s]: the slowest mode has decayed by exp(-60) for 30 masses

double tip_drop(int num_masses, double stiffness) {
  SpringRow row;
  row.num_springs = num_masses;
  row.spacing = 0.1;
  row.mass = kMass;
  row.direction = {0, -1, 0};
  // Twice the slowest mode's frequency: near-critical damping, the fastest way to rest.
  const double pi = std::acos(-1.0);
  const double slowest =
      2 * std::sqrt(stiffness / kMass) * std::sin(pi / (2 * (2 * num_masses + 1)));
  row.laws = {tension_law(stiffness), gravity_law({0, -kGravity, 0}),
              velocity_damping_law(2 * slowest)};
  reference::SpringSolver solver =
      make_solver(make_row(row), reference::IntegratorKind::kModifiedEuler);
  const int num_steps = static_cast<int>(std::lround(kEndTime / kTimeStep));
  for (int step = 0; step < num_steps; ++step) (void)solver.step(kTimeStep);
  const reference::Body& body = solver.system().bodies[0];
  return body.mesh.rest_positions(1, num_masses) - body.positions(1, num_masses);
}

}  // namespace

void evaluate_hanging_chain(const CaseInfo& info, const CaseOptions&, const EngineRuns&,
                            Report& report) {
  const Tolerance tolerance{1e-12, Basis::kRoundoff,
                            "rounding of a position of up to 3 m (0.1 m for one mass), divided by "
                            "a drop of 0.5 m (1 mm), "
                            "with room for what is left of the motion"};
  for (const int num_masses : {1, 10, 30}) {
    const double exact = kMass * kGravity * num_masses * (num_masses + 1) / (2 * kStiffness);
    const auto error = [&](double stiffness) {
      return std::abs(tip_drop(num_masses, stiffness) / exact - 1);
    };
    CheckResult check;
    check.case_id = info.id;
    check.engine = "reference";
    check.claim = "a chain of " + std::to_string(num_masses) + " masses hangs as theory says";
    check.metric = "relative error of the tip's drop";
    check.unit = "1";
    check.formula = "m g N (N + 1) / (2 k)";
    check.source = "statics of a hanging chain of springs";
    check.measured = error(kStiffness);
    check.tolerance = tolerance;
    check.verdict = judge(check.measured, tolerance);
    const double sabotaged = error(1.01 * kStiffness);
    check.sabotages.push_back(
        {"spring constant +1 %", sabotaged, judge(sabotaged, tolerance) == Verdict::kFail});
    check.note = "the tension law, gravity, or the run is too short to come to rest";
    report.checks.push_back(std::move(check));
  }
}

}  // namespace weft::validation
