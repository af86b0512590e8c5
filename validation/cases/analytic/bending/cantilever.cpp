// A heavy strip bends under its own weight (Romero et al. 2021, test 1): tip drop over tip reach
// against the elastica, over three decades of Gamma, on a grid at three angles.
// Tested by tests/validation/theory_test.cpp.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>

#include <weft/validation/cases/analytic/bending/bent_strip.hpp>
#include <weft/validation/cases/analytic/bending/elastica.hpp>
#include <weft/validation/cases/analytic/statics/lattice_strip.hpp>
#include <weft/validation/cases/support/analytic_cases.hpp>
#include <weft/validation/cases/support/closed_form_check.hpp>
#include <weft/validation/cases/support/parameters.hpp>
#include <weft/validation/metrics/series/convergence.hpp>

namespace weft::validation {
namespace cantilever {
namespace {

constexpr int kNumGammas = 12;
constexpr int kNumCells = 40;
constexpr double kStrain = 1e-3;  ///< of the springs under the whole weight [-]

double gamma_at(int index) {
  return 0.1 * std::pow(1000.0, index / (kNumGammas - 1.0));
}

/// One mesh over all Gammas.
struct Sweep {
  std::string title;
  StripModel model;
  std::vector<double> drop_over_reach;
  double largest_error = 0.0;  ///< relative; infinite if an equilibrium was not found
  ComparedValue worst = {};    ///< where it is
};

ComparedValue drop_over_reach(const BentStrip& strip, double gamma) {
  const HeavyElastica exact = solve_heavy_elastica(gamma);
  return {fmt::format("H / W at Gamma = {:.4g}", gamma),
          strip.converged ? strip.drop_over_reach : std::numeric_limits<double>::quiet_NaN(),
          exact.drop / exact.reach, "1"};
}

/// Infinite if the equilibrium was not found.
double error_of(const ComparedValue& pair) {
  return std::isnan(pair.value) ? std::numeric_limits<double>::infinity() : relative_error(pair);
}

double strip_error(const BentStrip& strip, double gamma) {
  return error_of(drop_over_reach(strip, gamma));
}

Sweep sweep(std::string title, StripModel model) {
  Sweep result{std::move(title), model, {}, 0.0, {}};
  Matrix3X<double> start;
  for (int i = 0; i < kNumGammas; ++i) {
    model.gamma = gamma_at(i);
    BentStrip strip = bend_strip(model, start);
    start = std::move(strip.positions);
    result.drop_over_reach.push_back(strip.drop_over_reach);
    const ComparedValue pair = drop_over_reach(strip, model.gamma);
    if (i == 0 || error_of(pair) > result.largest_error) {
      result.largest_error = error_of(pair);
      result.worst = pair;
    }
  }
  return result;
}

StripModel strip_model(int angle) {
  StripModel model;
  model.strip.angle = angle;
  model.strip.num_cells = kNumCells;
  model.strip.width_cells = angle == 45 ? 4 : 2;
  model.is_endless = angle == 45;
  model.strain = kStrain;
  return model;
}

std::string title_of(int angle) {
  if (angle == 45) return "45 degrees, a strip of an endless sheet";
  return fmt::format("{} degrees", angle);
}

/// Order of H / W at Gamma = 1 from 20, 40 and 80 cells, or 0.
double order(StripModel model) {
  model.gamma = 1.0;
  std::array<double, 3> results{};
  for (std::size_t level = 0; level < 3; ++level) {
    model.strip.num_cells = 20 << level;
    results[level] = bend_strip(model).drop_over_reach;
  }
  // The cut along diagonals takes a whole number of them: 14, 28 and 57 for the three levels.
  return order_of_differences(std::abs(results[2] - results[1]), std::abs(results[1] - results[0]),
                              2.0)
      .value_or(0.0);
}

CheckResult check_of(const CaseInfo& info, const std::string& title) {
  CheckResult check;
  check.case_id = info.id;
  check.engine = "reference statics";
  check.formula = "theta'' + Gamma (1 - s) cos(theta) = 0, theta(0) = 0, theta'(1) = 0";
  check.source = "heavy elastica, solved on the spot; Romero et al. 2021, test 1";
  check.unit = "1";
  check.claim = title;
  return check;
}

void add_error_check(const CaseInfo& info, const Sweep& good, Report& report) {
  CheckResult check = check_of(info, "a heavy strip hangs as the elastica, " + good.title);
  check.metric =
      fmt::format("largest relative error of H / W, 12 Gammas 0.1 to 100, N = {}", kNumCells);
  check.measured = good.largest_error;
  check.values = {good.worst};
  const Tolerance tolerance{0.01, Basis::kTruncation,
                            "second order: 0.33 % at Gamma = 100 for a chain of 40, and what the "
                            "springs stretch"};
  check.tolerance = tolerance;
  check.verdict = judge(check.measured, tolerance);
  check.note = "the weights or the clamp rule of hinge_torsion, or the static solver";
  const auto sabotage = [&](const std::string& name, StripModel model, double gamma) {
    model.gamma = gamma;
    const double measured = strip_error(bend_strip(model), gamma);
    check.sabotages.push_back({name, measured, judge(measured, tolerance) == Verdict::kFail});
  };
  StripModel plain_clamp = good.model;
  plain_clamp.clamp_factor = 1.0;
  sabotage("hinges at the clamp not doubled", plain_clamp, 1.0);
  StripModel one_way = good.model;
  one_way.cut_one_way = true;
  sabotage("cells cut one way only", one_way, 1.0);
  report.checks.push_back(std::move(check));
}

void add_order_check(const CaseInfo& info, int angle, Report& report) {
  CheckResult check =
      check_of(info, "the error falls with the square of the cell, " + title_of(angle));
  check.metric = "|observed order - 2| of H / W at Gamma = 1, N = 20, 40, 80";
  check.measured = std::abs(order(strip_model(angle)) - 2);
  const Tolerance tolerance{0.2, Basis::kTruncation,
                            "a first-order clamp would show 1; whole diagonals shift the levels"};
  check.tolerance = tolerance;
  check.verdict = judge(check.measured, tolerance);
  StripModel plain_clamp = strip_model(angle);
  plain_clamp.clamp_factor = 1.0;
  const double measured = std::abs(order(plain_clamp) - 2);
  check.sabotages.push_back(
      {"hinges at the clamp not doubled", measured, judge(measured, tolerance) == Verdict::kFail});
  check.note = "the clamp rule of hinge_torsion";
  report.checks.push_back(std::move(check));
}

Sweep add_jittered_check(const CaseInfo& info, Report& report) {
  StripModel model = strip_model(0);
  model.strip.jitter = 0.2;
  model.strip.width_cells = 8;
  Sweep jittered = sweep("0 degrees, nodes off by up to 20 %", model);
  CheckResult check = check_of(info, "a heavy strip of an irregular grid hangs as the elastica");
  check.metric = "largest relative error of H / W, nodes off by up to 20 % of a cell, N = 40";
  check.measured = jittered.largest_error;
  check.values = {jittered.worst};
  const Tolerance tolerance{0.05, Basis::kModelGap,
                            "no hinge energy is exact on irregular cells; measured below 1 %"};
  check.tolerance = tolerance;
  check.verdict = judge(check.measured, tolerance);
  StripModel plain_clamp = model;
  plain_clamp.clamp_factor = 1.0;
  plain_clamp.cut_one_way = true;
  plain_clamp.gamma = 1.0;
  const double measured = strip_error(bend_strip(plain_clamp), 1.0);
  check.sabotages.push_back(
      {"cells cut one way only", measured, judge(measured, tolerance) == Verdict::kFail});
  check.note = "the weights of hinge_torsion";
  report.checks.push_back(std::move(check));
  return jittered;
}

/// Free sides along diagonals lack half a cell's hinges: not gated, for it is a property of the cut.
void add_free_sides_row(const CaseInfo& info, Report& report) {
  StripModel model = strip_model(45);
  model.is_endless = false;
  model.strip.num_cells = 20;
  model.strip.width_cells = 14;
  model.gamma = 1.0;
  CheckResult check = check_of(info, "a strip cut along diagonals has soft sides");
  check.metric = "relative error of H / W at Gamma = 1, as wide as long, N = 20";
  check.values = {drop_over_reach(bend_strip(model), 1.0)};
  check.measured = error_of(check.values[0]);
  check.note = "half a diagonal's hinges are missing on each side: first order in cell over width";
  report.checks.push_back(std::move(check));
}

/// One strip that anyone may ask for.
struct Point {
  double gamma = 1.0;
  double angle = 0.0;  ///< of the grid to the strip [deg]
  double tilt = 0.0;   ///< of the clamp below the horizontal [deg]
  int cells = 40;
};

/// Cells that the layer of bending at the clamp, L / sqrt(2 Gamma), needs.
int chosen_cells(double gamma) {
  return std::max(kNumCells, static_cast<int>(std::ceil(4 * std::sqrt(gamma))));
}

/// Way of the tip from the straight strip: error over length, so that a tip straight below counts like any other.
struct Way {
  double error = std::numeric_limits<double>::infinity();
  std::vector<ComparedValue> values = {};
};

Way way_of(const Point& point, double rigidity_factor) {
  const double tilt = point.tilt * std::numbers::pi / 180;
  StripModel model;
  model.strip.angle = point.angle;
  model.strip.num_cells = point.cells;
  model.strip.width_cells = point.angle == 45 ? 4 : 2;
  model.is_endless = point.angle != 0 && point.angle != 90;
  model.strain = kStrain;
  model.gamma = point.gamma / rigidity_factor;
  model.tilt = tilt;
  const BentStrip strip = bend_strip(model);
  if (!strip.converged) return {};
  const HeavyElastica exact = solve_elastica({.gamma = point.gamma, .tilt = tilt});
  if (point.tilt == 0) {
    const ComparedValue pair{"H / W", strip.drop_over_reach, exact.drop / exact.reach, "1"};
    return {relative_error(pair), {pair}};
  }
  const double drop = strip.tip.drop / model.strip.length;
  const double reach = strip.tip.reach / model.strip.length;
  return {std::hypot(drop - exact.drop, reach - exact.reach) /
              std::hypot(exact.drop - std::sin(tilt), exact.reach - std::cos(tilt)),
          {{"H / L", drop, exact.drop, "1"}, {"W / L", reach, exact.reach, "1"}}};
}

void add_point_check(const CaseInfo& info, const Point& point, Report& report) {
  const LatticeDirection direction = nearest_direction(point.angle);
  CheckResult check = check_of(
      info, fmt::format("a heavy strip hangs as the elastica, Gamma = {}, grid at {} degrees{}",
                        point.gamma, point.angle,
                        point.tilt == 0 ? "" : fmt::format(", clamp {} degrees down", point.tilt)));
  check.metric =
      fmt::format("relative error of {}, N = {}, grid at {:.1f} degrees",
                  point.tilt == 0 ? "H / W" : "the tip's way", point.cells, direction.angle());
  if (point.tilt != 0) {
    check.formula = "theta'' + Gamma (1 - s) cos(theta) = 0, theta(0) = tilt, theta'(1) = 0";
  }
  const Way way = way_of(point, 1.0);
  check.measured = way.error;
  check.values = way.values;
  const double fine = static_cast<double>(chosen_cells(point.gamma)) / point.cells;
  const Tolerance tolerance{0.01 * std::max(1.0, fine * fine), Basis::kTruncation,
                            "1 % with cells enough for the layer of bending at the clamp"};
  check.tolerance = tolerance;
  check.verdict = judge(check.measured, tolerance);
  // Where the clamp hangs down a heavy strip hangs straight, however stiff.
  const double stiffer = 1 + (point.tilt == 0 ? 5 : 50) * tolerance.value;
  const double sabotaged = way_of(point, stiffer).error;
  check.sabotages.push_back({fmt::format("rigidity +{:.0f} %", 100 * (stiffer - 1)), sabotaged,
                             judge(sabotaged, tolerance) == Verdict::kFail});
  check.note = "hinge_torsion, its clamp, or the static solver";
  report.checks.push_back(std::move(check));
}

constexpr std::array kParameters = {
    CaseParameter{"gamma", "1", "rho g L^3 / D", 0.05, 500.0, 1.0},
    CaseParameter{"nodes", "1", "cells along the strip", 10, 160, std::nullopt, true},
    CaseParameter{"angle", "deg",
                  "of the grid's lines to the strip; the nearest at which a grid repeats is taken",
                  0.0, 90.0, 0.0},
    CaseParameter{"tilt", "deg", "of the clamp below the horizontal", -80.0, 60.0, 0.0},
};

}  // namespace
}  // namespace cantilever

std::span<const CaseParameter> cantilever_parameters() {
  using namespace cantilever;
  return kParameters;
}

void evaluate_cantilever(const CaseInfo& info, const CaseOptions& options, const EngineRuns&,
                         Report& report) {
  using namespace cantilever;
  if (asks_for_point(options)) {
    const auto value = [&](const char* name) { return value_of(info, options, name); };
    const double gamma = value("gamma");
    add_point_check(info,
                    {gamma, value("angle"), value("tilt"),
                     static_cast<int>(value_or(options, "nodes", chosen_cells(gamma)))},
                    report);
    return;
  }
  std::vector<Sweep> sweeps;
  for (const int angle : {0, 45, 90}) {
    sweeps.push_back(sweep(title_of(angle), strip_model(angle)));
    add_error_check(info, sweeps.back(), report);
    add_order_check(info, angle, report);
  }
  sweeps.push_back(add_jittered_check(info, report));
  add_free_sides_row(info, report);
  for (const Point& point : {Point{0.05}, Point{200}, Point{500}, Point{3.7, 17}, Point{30, 63},
                             Point{3.7, 0, 30}, Point{3.7, 0, -40}}) {
    Point chosen = point;
    chosen.cells = chosen_cells(point.gamma);
    add_point_check(info, chosen, report);
  }

  Section section{std::string(info.id), std::string(info.summary), {}, {}, {}, ""};
  Plot plot{"Tip drop over tip reach", "Gamma = rho g L^3 / D [1]", "H / W [1]", true, true, {}};
  Series exact{"elastica", {}, {}};
  Table table{"H / W", {"Gamma [1]", "elastica"}, {}};
  for (const Sweep& each : sweeps) table.columns.push_back(each.title);
  for (int i = 0; i < kNumGammas; ++i) {
    const HeavyElastica tip = solve_heavy_elastica(gamma_at(i));
    exact.x.push_back(gamma_at(i));
    exact.y.push_back(tip.drop / tip.reach);
    table.rows.push_back(
        {fmt::format("{:.4g}", gamma_at(i)), fmt::format("{:.6f}", exact.y.back())});
    for (const Sweep& each : sweeps) {
      const double value = each.drop_over_reach[static_cast<std::size_t>(i)];
      table.rows.back().push_back(
          fmt::format("{:.6f} ({:+.3f} %)", value, 100 * (value / exact.y.back() - 1)));
    }
  }
  plot.series.push_back(exact);
  for (const Sweep& each : sweeps) {
    plot.series.push_back({each.title, exact.x, each.drop_over_reach});
  }
  section.plots.push_back(std::move(plot));
  section.tables.push_back(std::move(table));
  report.sections.push_back(std::move(section));
}

}  // namespace weft::validation
