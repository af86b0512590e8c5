// A swinging, stretching spring pendulum: does the error fall with the step as each integrator
// promises?
// Tested by tests/apps/CMakeLists.txt.
#include <array>
#include <cmath>

#include <weft/validation/cases/support/analytic_cases.hpp>
#include <weft/validation/cases/support/small_systems.hpp>

namespace weft::validation {
namespace observed_orders {
namespace {

using reference::IntegratorKind;

constexpr double kEndTime = 1.0;  // [s]
constexpr int kNumLevels = 4;     // steps h, h/2, h/4, h/8

struct Ladder {
  IntegratorKind integrator;
  int first_num_steps;  ///< so small a step that the leading error term rules, so large that
                        ///< rounding does not
  double order;
};

constexpr Ladder kLadders[] = {
    {IntegratorKind::kExplicitEuler, 8000, 1},   {IntegratorKind::kModifiedEuler, 1000, 1},
    {IntegratorKind::kVelocityVerlet, 500, 2},   {IntegratorKind::kRungeKutta4, 200, 4},
    {IntegratorKind::kYoshida4, 200, 4},         {IntegratorKind::kImplicitEuler, 4000, 1},
    {IntegratorKind::kTrBdf2, 200, 2},           {IntegratorKind::kImplicitMidpoint, 200, 2},
    {IntegratorKind::kGeneralizedAlpha, 200, 2},
};

Vector3<double> end_position(IntegratorKind integrator, int num_steps, bool unset_velocity) {
  SpringRow row;
  row.laws = {tension_law(100.0), gravity_law({0, -9.81, 0})};
  reference::Body body = make_row(row);
  body.positions.col(1) << 0.6, -1.2, 0.0;
  if (!unset_velocity) body.velocities.col(1) << 0.5, 0.0, 0.3;
  reference::SpringSolver solver = make_solver(std::move(body), integrator);
  for (int step = 0; step < num_steps; ++step) (void)solver.step(kEndTime / num_steps);
  return solver.system().bodies[0].positions.col(1);
}

struct Study {
  std::array<double, kNumLevels> steps{};   ///< [s]
  std::array<double, kNumLevels> errors{};  ///< [m]
  double order = 0;                         ///< of the last halving
};

Study study(const Ladder& ladder, bool unset_velocity) {
  // RK4 with a step at which its discretization error is far below every error measured here.
  static const Vector3<double> kReferenceEnd =
      end_position(IntegratorKind::kRungeKutta4, 20000, false);
  Study result;
  for (std::size_t level = 0; level < kNumLevels; ++level) {
    const int num_steps = ladder.first_num_steps << level;
    result.steps[level] = kEndTime / num_steps;
    result.errors[level] =
        (end_position(ladder.integrator, num_steps, unset_velocity) - kReferenceEnd).norm();
  }
  result.order = std::log2(result.errors[kNumLevels - 2] / result.errors[kNumLevels - 1]);
  return result;
}

}  // namespace
}  // namespace observed_orders

void evaluate_observed_orders(const CaseInfo& info, const CaseOptions&, const EngineRuns&,
                              Report& report) {
  using namespace observed_orders;
  const Tolerance tolerance{0.15, Basis::kTruncation,
                            "the next term of the error expansion at these steps"};
  Section section{std::string(info.id), std::string(info.summary), {}, {}, {}, ""};
  Plot plot{"Error after 1 s against the step", "step [s]", "position error [m]", true, true, {}};
  for (const Ladder& ladder : kLadders) {
    const Study right = study(ladder, false);
    const Study sabotaged = study(ladder, true);
    CheckResult check;
    check.case_id = info.id;
    check.engine = "reference";
    check.claim = std::string(name_of(ladder.integrator)) + " has order " +
                  std::to_string(static_cast<int>(ladder.order));
    check.metric = "observed order minus expected order";
    check.unit = "1";
    check.formula = "p = log2(e(h) / e(h/2))";
    check.source =
        "spring pendulum m = 1 kg, k = 100 N/m, l0 = 1 m; reference solution: Runge-Kutta 4, 20000 "
        "steps";
    check.measured = std::abs(right.order - ladder.order);
    check.tolerance = tolerance;
    check.verdict = judge(check.measured, tolerance);
    const double off = std::abs(sabotaged.order - ladder.order);
    check.sabotages.push_back(
        {"initial velocity unset", off, judge(off, tolerance) == Verdict::kFail});
    check.note = "a term of the scheme is missing, or forces are evaluated at the wrong state";
    report.checks.push_back(std::move(check));
    plot.series.push_back({name_of(ladder.integrator),
                           {right.steps.begin(), right.steps.end()},
                           {right.errors.begin(), right.errors.end()}});
  }
  section.plots.push_back(std::move(plot));
  report.sections.push_back(std::move(section));
}

}  // namespace weft::validation
