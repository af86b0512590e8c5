// Two instabilities of a heavy strip: upright it falls over, on edge it tips sideways.
// Tested by tests/validation/theory_test.cpp.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include <weft/validation/cases/analytic/bending/bent_strip.hpp>
#include <weft/validation/cases/support/analytic_cases.hpp>
#include <weft/validation/cases/support/closed_form_check.hpp>
#include <weft/validation/cases/support/parameters.hpp>

namespace weft::validation {
namespace buckling {
namespace {

constexpr double kColumn = 7.8373;    ///< rho g L^3 / D of a column: (9/4) j(-1/3, 1)^2
constexpr double kLateral = 12.8538;  ///< q L^3 / sqrt(EI GJ): 6 x first zero of J_(-1/6)

struct Buckling {
  bool is_lateral = false;  ///< else a column
  int cells = 40;           ///< along the strip
  int width_cells = 2;
  double rigidity_factor = 1.0;  ///< sabotage

  [[nodiscard]] double width() const {  ///< of the strip over its length [-]
    return static_cast<double>(width_cells) / cells;
  }
  /// A strip of hinges has EI = D w and, its Poisson's ratio being 0, GJ = 2 D w. It cannot warp at its clamp: with the
  /// warping rigidity D w^3 / 12 a twist begins as if it were sqrt(D w^3 / 12 / GJ) = w / sqrt(24) shorter.
  [[nodiscard]] double exact() const {
    if (!is_lateral) return kColumn;
    return kLateral * std::numbers::sqrt2 / std::pow(1 - width() / std::sqrt(24.0), 3);
  }
};

/// Where the strip goes under a push of this share of its weight across it: the tip's way over the push and
/// the length, 0 if it was not found. Far from a buckling load the response is linear.
double response(const Buckling& buckling, double gamma) {
  StripModel model;
  model.strip.num_cells = buckling.cells;
  model.strip.width_cells = buckling.width_cells;
  model.gamma = gamma / buckling.rigidity_factor;
  // A deep strip also sags in its own plane: by 12 gamma (strain / gamma) (L / w)^2 / 8 of its length.
  const double slender = static_cast<double>(buckling.cells) / buckling.width_cells;
  model.strain = buckling.is_lateral ? 2e-3 / (slender * slender) : 1e-4;
  model.tilt = buckling.is_lateral ? 0.0 : -std::numbers::pi / 2;  // upright
  reference::Body body = make_strip_body(model);
  const double gravity = 9.81;  // [m/s^2]
  const double weight = body.mesh.masses.sum() * gravity;
  constexpr double kPush = 1e-9;
  reference::StaticProblem problem = reference::static_problem(body, weight);
  if (buckling.is_lateral) {
    // The same strip on its edge: gravity along its width instead of across it.
    const Matrix3X<double> down = Vector3<double>(0, -gravity, 0) * body.mesh.masses.transpose();
    const Matrix3X<double> aside = Vector3<double>(0, 0, -gravity) * body.mesh.masses.transpose();
    problem.forces = [forces = problem.forces, change = Matrix3X<double>(aside - down)](
                         const Matrix3X<double>& x, Matrix3X<double>& f) {
      forces(x, f);
      f += change;
    };
  }
  Matrix3X<double> straight = body.mesh.rest_positions;
  reference::StaticOptions options;
  // Rounding of springs as stiff as weight over strain.
  options.residual = std::max(1e-12, 1e-14 / model.strain);
  options.max_move = 0.01 * model.strip.length;
  options.max_iterations = 20;
  (void)reference::solve_statics(problem, straight, options);
  problem.forces = [forces = problem.forces, &body, gravity](const Matrix3X<double>& x,
                                                             Matrix3X<double>& f) {
    forces(x, f);
    f.row(1) += kPush * gravity * body.mesh.masses.transpose();
  };
  Matrix3X<double> pushed = straight;
  options.max_iterations = 2;
  options.residual = 0;
  (void)reference::solve_statics(problem, pushed, options);
  const double end = body.mesh.rest_positions.row(0).maxCoeff();
  for (int node = 0; node < body.mesh.num_nodes(); ++node) {
    if (body.mesh.rest_positions(0, node) < end * (1 - 1e-9)) continue;
    return (pushed(1, node) - straight(1, node)) / (kPush * model.strip.length);
  }
  return 0.0;
}

/// Where the stiffness against a sideways push, gamma / response, vanishes. It falls with gamma for a column and
/// with its square for a beam on edge, which does not care which way up it is; secants in that from below. No
/// point comes closer than a hundredth: above the load the strip goes elsewhere.
double critical_gamma(const Buckling& buckling) {
  const auto gamma_of = [&](double x) { return buckling.is_lateral ? std::sqrt(x) : x; };
  const auto stiffness = [&](double x) { return gamma_of(x) / response(buckling, gamma_of(x)); };
  const double exact = buckling.is_lateral ? std::pow(buckling.exact(), 2) : buckling.exact();
  double a = 0.4 * exact;
  double b = 0.6 * exact;
  double at_a = stiffness(a);
  double at_b = stiffness(b);
  const auto root = [&] { return b - at_b * (b - a) / (at_b - at_a); };
  for (const double part : {0.9, 0.98}) {
    const double next = part * root();
    if (!(next > b)) break;
    a = b;
    at_a = at_b;
    b = next;
    at_b = stiffness(b);
  }
  return gamma_of(root());
}

void add_check(const CaseInfo& info, const Buckling& buckling, Report& report) {
  const auto load = [](const Buckling& each) {
    return ComparedValue{"largest rho g L^3 / D", critical_gamma(each), each.exact(), "1"};
  };
  ClosedForm form;
  form.engine = "reference statics";
  form.metric = fmt::format("relative error of the largest rho g L^3 / D, {} x {} cells",
                            buckling.cells, buckling.width_cells);
  form.note = "hinge_torsion: its twist or its clamp; or tension that should not resist bending";
  if (buckling.is_lateral) {
    form.claim = "a strip on its edge tips sideways at the load of a beam";
    form.formula = "q (L - w / sqrt(24))^3 / sqrt(EI GJ) = 12.8538, EI = D w, GJ = 2 D w";
    form.source =
        "Prandtl 1899, Michell 1899; Vlasov for the warping at the clamp; Poisson's ratio 0";
    const double coarse = std::max(1.0, 40.0 / buckling.cells);
    form.tolerance = {0.01 * coarse * coarse + buckling.width() * buckling.width(),
                      Basis::kTruncation,
                      "second order in the cells, 0.3 % for 40, and (w / L)^2 that a beam's theory "
                      "leaves out"};
  } else {
    form.claim = "an upright strip falls over at Greenhill's load";
    form.formula = "rho g L^3 / D = (9 / 4) j^2, j = 1.86635 the first zero of J_(-1/3)";
    form.source = "Greenhill 1881";
    form.tolerance = {0.01 * std::max(1.0, 40.0 / buckling.cells), Basis::kTruncation,
                      "second order in the cells"};
  }
  CheckResult check = judged(info, form, load(buckling));
  Buckling wrong = buckling;
  // A wide strip's bound is wide, and so is the mistake that must break it.
  wrong.rigidity_factor = 1 + std::max(0.1, 3 * check.tolerance->value);
  add_sabotage(check, fmt::format("rigidity {:+.0f} %", 100 * (wrong.rigidity_factor - 1)),
               relative_error(load(wrong)));
  report.checks.push_back(std::move(check));
}

constexpr std::array kParameters = {
    CaseParameter{"nodes", "1", "cells along the upright strip", 10, 160, 40, true},
    CaseParameter{"lateral-nodes", "1", "cells along the strip on its edge", 40, 240, 160, true},
    CaseParameter{"width-nodes", "1", "cells across the strip on its edge", 2, 16, 8, true},
};

}  // namespace
}  // namespace buckling

std::span<const CaseParameter> buckling_parameters() {
  using namespace buckling;
  return kParameters;
}

void evaluate_buckling(const CaseInfo& info, const CaseOptions& options, const EngineRuns&,
                       Report& report) {
  using namespace buckling;
  const auto whole = [&](const char* name) {
    return static_cast<int>(value_of(info, options, name));
  };
  add_check(info, {.cells = whole("nodes")}, report);
  add_check(
      info,
      {.is_lateral = true, .cells = whole("lateral-nodes"), .width_cells = whole("width-nodes")},
      report);
}

}  // namespace weft::validation
