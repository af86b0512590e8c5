// Masses on springs, one below the other: the tip drops by m g N (N + 1) / (2 k), for every N.
// Tested by tests/validation/theory_test.cpp, tests/validation/cases/support/parameters_test.cpp.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include <weft/validation/cases/support/analytic_cases.hpp>
#include <weft/validation/cases/support/closed_form_check.hpp>
#include <weft/validation/cases/support/parameters.hpp>
#include <weft/validation/cases/support/small_systems.hpp>

namespace weft::validation {
namespace hanging_chain {
namespace {

constexpr double kGravity = 9.81;  // [m/s^2]

struct Chain {
  int masses = 10;
  double mass = 0.1;          ///< of each [kg]
  double stiffness = 1000.0;  ///< of each spring [N/m]
};

double tip_drop(const Chain& chain) {
  SpringRow row;
  row.num_springs = chain.masses;
  row.spacing = 0.1;
  row.mass = chain.mass;
  row.direction = {0, -1, 0};
  // Twice the slowest mode's frequency: near-critical damping, the fastest way to rest.
  const double rate = std::sqrt(chain.stiffness / chain.mass);  // [1/s]
  const double slowest = 2 * rate * std::sin(std::numbers::pi / (2 * (2 * chain.masses + 1)));
  row.laws = {tension_law(chain.stiffness), gravity_law({0, -kGravity, 0}),
              velocity_damping_law(2 * slowest)};
  reference::SpringSolver solver =
      make_solver(make_row(row), reference::IntegratorKind::kModifiedEuler);
  // A twentieth of the stable step 2 / (2 rate); at the end the slowest mode has decayed by exp(-60).
  const double time_step = 0.1 / rate;
  const long num_steps = std::lround(60 / (slowest * time_step));
  for (long step = 0; step < num_steps; ++step) (void)solver.step(time_step);
  const reference::Body& body = solver.system().bodies[0];
  return body.mesh.rest_positions(1, chain.masses) - body.positions(1, chain.masses);
}

void add_check(const CaseInfo& info, const Chain& chain, Report& report) {
  const int n = chain.masses;
  const double exact = chain.mass * kGravity * n * (n + 1) / (2 * chain.stiffness);
  const double length = 0.1 * n + exact;
  ClosedForm form;
  form.claim = "a chain of " + std::to_string(n) + " masses hangs as theory says";
  form.metric = "relative error of the tip's drop";
  form.formula = "m g N (N + 1) / (2 k)";
  form.source = "statics of a hanging chain of springs";
  form.tolerance = {std::max(2e-14 * length / exact, 1e-13), Basis::kRoundoff,
                    "some tens of roundings of a position as far down as the tip, over its drop"};
  form.note = "the tension law, gravity, or the run is too short to come to rest";
  const auto drop = [&](const Chain& each) {
    return ComparedValue{"drop of the tip", tip_drop(each), exact, "m"};
  };
  CheckResult check = judged(info, form, drop(chain));
  Chain wrong = chain;
  wrong.stiffness *= 1.01;
  add_sabotage(check, "spring constant +1 %", relative_error(drop(wrong)));
  report.checks.push_back(std::move(check));
}

constexpr std::array kParameters = {
    CaseParameter{"masses", "1", "of the chain", 1, 200, 10.0, true},
    CaseParameter{"mass", "kg", "of each", 1e-4, 10.0, 0.1},
    CaseParameter{"stiffness", "N/m", "of each spring", 1.0, 1e6, 1000.0},
};

}  // namespace
}  // namespace hanging_chain

std::span<const CaseParameter> hanging_chain_parameters() {
  using namespace hanging_chain;
  return kParameters;
}

void evaluate_hanging_chain(const CaseInfo& info, const CaseOptions& options, const EngineRuns&,
                            Report& report) {
  using namespace hanging_chain;
  if (asks_for_point(options)) {
    add_check(info,
              {static_cast<int>(value_of(info, options, "masses")), value_of(info, options, "mass"),
               value_of(info, options, "stiffness")},
              report);
    return;
  }
  for (const int masses : {1, 10, 30}) add_check(info, {.masses = masses}, report);
}

}  // namespace weft::validation
