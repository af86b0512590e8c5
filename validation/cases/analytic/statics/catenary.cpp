// A chain between two points of one height: the elastic catenary, and with stiff springs the catenary.
#include <array>
#include <cmath>

#include <fmt/format.h>

#include <weft/custom_forces/registry.hpp>
#include <weft/reference/statics/static_solver.hpp>
#include <weft/validation/cases/analytic/statics/catenary.hpp>
#include <weft/validation/cases/support/analytic_cases.hpp>
#include <weft/validation/cases/support/closed_form_check.hpp>
#include <weft/validation/cases/support/parameters.hpp>
#include <weft/validation/cases/support/small_systems.hpp>

namespace weft::validation {
namespace catenary {
namespace {

constexpr double kSpan = 1.0;          // d [m]
constexpr double kGravity = 9.81;      // [m/s^2]
constexpr double kInextensible = 1e6;  ///< EA / (w d) of a chain that counts as inextensible [-]

/// Static chain of springs of mass w a / g per node. weight: of it over what the formula is told [-].
CableShape hang(const Cable& cable, double weight) {
  const int n = cable.springs;
  const double spacing = cable.length * kSpan / n;
  constexpr double kWeight = 10.0;  // w [N/m]
  SpringRow row;
  row.num_springs = n;
  row.spacing = spacing;
  row.mass = weight * kWeight * spacing / kGravity;
  const double stiffness = cable.stiffness * kWeight * kSpan / spacing;
  row.laws = {tension_law(stiffness), gravity_law({0, -kGravity, 0})};
  reference::Body body = make_row(row);
  body.mesh.pinned = {0, n};
  // From a parabola of about the right length: the equilibrium is the solver's to find.
  const double guess = std::sqrt(std::max(cable.length - 1, 0.01) * 3 / 8);
  Matrix3X<double> positions = body.mesh.rest_positions;
  for (int i = 0; i <= n; ++i) {
    const double s = static_cast<double>(i) / n;
    positions.col(i) << s * kSpan, -4 * guess * s * (1 - s) * kSpan, 0;
  }
  const reference::StaticProblem problem = reference::static_problem(body, kWeight * kSpan);
  reference::StaticOptions options;
  // Rounding of a position, 1e-16 d, times a spring.
  options.residual = std::max(1e-11, 1e-15 * cable.stiffness * n);
  options.max_move = 0.05 * kSpan;
  options.max_iterations = 2000;
  if (!reference::solve_statics(problem, positions, options).converged) {
    return {std::nan(""), std::nan(""), std::nan("")};
  }
  const Vector3<double> first = positions.col(1) - positions.col(0);
  const double force = stiffness * (first.norm() - spacing) / (kWeight * kSpan);
  const double pull = force * first.x() / first.norm();
  // At the end itself half a node's weight more than in the first spring.
  const double lift = -force * first.y() / first.norm() + weight * cable.length / n / 2;
  return {pull, -positions.row(1).minCoeff() / kSpan, std::hypot(pull, lift)};
}

double largest_error(const CableShape& measured, const CableShape& exact) {
  const double errors = std::abs(measured.pull / exact.pull - 1) +
                        std::abs(measured.sag / exact.sag - 1) +
                        std::abs(measured.tension / exact.tension - 1);
  return errors;  // a sum: what is not a number stays so
}

CheckResult add_check(const CaseInfo& info, const Cable& cable, const CableShape& exact,
                      const std::string& source, Report& report) {
  const bool is_stiff = cable.stiffness >= kInextensible;
  const std::string what =
      is_stiff ? fmt::format("an inextensible chain of {} d", cable.length)
               : fmt::format("a chain of {} d, EA = {} w d", cable.length, cable.stiffness);
  const CableShape measured = hang(cable, 1.0);
  CheckResult check = judged(
      info,
      {what + " hangs as the catenary",
       fmt::format("relative errors of pull, sag and largest tension, sum, N = {}", cable.springs),
       "d = H L0 / EA + (2 H / w) asinh(w L0 / (2 H))",
       source,
       {1e-3 * std::max(1.0, std::pow(100.0 / cable.springs, 2)), Basis::kTruncation,
        "second order in the springs: 1e-3 for 100"},
       "the tension law, the masses, or the static solver",
       "reference statics"},
      largest_error(measured, exact));
  check.values = {{"horizontal pull over w d", measured.pull, exact.pull, "1"},
                  {"sag over d", measured.sag, exact.sag, "1"},
                  {"largest tension over w d", measured.tension, exact.tension, "1"}};
  add_sabotage(check, "masses +1 %", largest_error(hang(cable, 1.01), exact));
  Cable softer = cable;
  softer.length *= 1.01;
  add_sabotage(check, "springs 1 % longer", largest_error(hang(softer, 1.0), exact));
  report.checks.push_back(check);
  return check;
}

/// Tabulated H, sag and largest tension over w d.
struct Row {
  Cable cable;
  CableShape exact;
};
constexpr std::array kTable = {Row{{1.2, 1200}, {.468698, .292818, .761366}},
                               Row{{1.2, 120}, {.461352, .297014, .756866}},
                               Row{{1.2, 12}, {.405121, .333842, .723963}},
                               Row{{1.0, 1000}, {3.456022, .036106, 3.492004}},
                               Row{{1.0, 100}, {1.586167, .078190, 1.663107}},
                               Row{{1.0, 10}, {.699764, .172777, .860040}},
                               Row{{1.05, kInextensible}, {.919640, .139304, 1.058944}},
                               Row{{1.2, kInextensible}, {.469542, .292344, .761885}},
                               Row{{2.0, kInextensible}, {.229640, .796388, 1.026029}},
                               Row{{3.0, kInextensible}, {.176153, 1.334155, 1.510308}}};

constexpr std::array kParameters = {
    CaseParameter{"length", "1", "unstretched length over the span", 0.8, 5.0, 1.2},
    CaseParameter{
        "stiffness", "1",
        "EA over weight per length times span; from 1e6 on the chain counts as inextensible", 5.0,
        1e6, 120.0},
    CaseParameter{"nodes", "1", "springs of the chain", 50, 1000, 100, true},
};

}  // namespace
}  // namespace catenary

CableShape exact_cable(const Cable& cable) {
  using namespace catenary;
  const double half = cable.length / 2;  // V / (w d)
  const auto span = [&](double pull) {
    return pull * cable.length / cable.stiffness + 2 * pull * std::asinh(half / pull);
  };
  double low = 1e-6;
  double high = cable.stiffness;
  while (high - low > 1e-14 * high) {
    const double middle = 0.5 * (low + high);
    if (middle == low || middle == high) break;
    (span(middle) > 1 ? high : low) = middle;
  }
  const double pull = 0.5 * (low + high);
  const double end = std::hypot(pull, half);
  return {pull, cable.length * cable.length / (8 * cable.stiffness) + end - pull, end};
}

std::span<const CaseParameter> catenary_parameters() {
  using namespace catenary;
  return kParameters;
}

void evaluate_catenary(const CaseInfo& info, const CaseOptions& options, const EngineRuns&,
                       Report& report) {
  using namespace catenary;
  if (asks_for_point(options)) {
    const Cable cable{value_of(info, options, "length"), value_of(info, options, "stiffness"),
                      static_cast<int>(value_of(info, options, "nodes"))};
    add_check(info, cable, exact_cable(cable), "elastic catenary, solved on the spot", report);
    return;
  }
  for (const Row& row : kTable) {
    add_check(info, row.cable, row.exact, "elastic catenary, six tabulated digits", report);
  }
}

}  // namespace weft::validation
