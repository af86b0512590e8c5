// Small vibrations of chains, strings, membranes and strips: against the formula of the discrete body, which is
// exact, and against the continuum with nodes enough.
// Tested by tests/validation/theory_test.cpp.
#include <array>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include <weft/custom_forces/registry.hpp>
#include <weft/mesh/cloth_grid.hpp>
#include <weft/validation/cases/analytic/bending/bent_strip.hpp>
#include <weft/validation/cases/analytic/dynamics/mode_shapes.hpp>
#include <weft/validation/cases/support/analytic_cases.hpp>
#include <weft/validation/cases/support/closed_form_check.hpp>
#include <weft/validation/cases/support/parameters.hpp>
#include <weft/validation/cases/support/small_systems.hpp>

namespace weft::validation {
namespace frequencies {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr int kSteps = 2000;
constexpr double kPhase = 0.02;  ///< omega h of the mode that is watched [rad]

/// phase: omega h of the run [rad].
Tolerance discrete_tolerance(double phase) {
  const double short_of = std::max(1.0, kPhase / phase);
  return {
      2e-10 * short_of * short_of, Basis::kRoundoff,
      "displacements of 1e-5 of a spacing: their squares, and the rounding of positions over the "
      "(w h)^2 of the fit"};
}

/// A mistake in the masses that a bound must notice [-].
double mass_mistake(const Tolerance& tolerance) {
  return 1 + std::max(0.01, 4 * tolerance.value);
}

/// A row of masses on springs along x: its axial or its transverse vibration.
struct Row {
  int masses = 20;
  int mode = 1;
  double mass = 0.1;                       ///< of a node [kg]
  double stiffness = 400.0;                ///< of a spring [N/m]
  double strain = 0.0;                     ///< at rest, of the spacing [-]
  bool is_free = false;                    ///< the far end
  static constexpr double kSpacing = 0.1;  // a [m]

  [[nodiscard]] double tension() const { return stiffness * kSpacing * strain; }
  /// 2 sqrt(stiffness along the motion / m) sin(q a / 2), q a the phase from node to node.
  [[nodiscard]] double phase() const {
    return is_free ? (2 * mode - 1) * kPi / (2 * masses + 1) : mode * kPi / (masses + 1);
  }
  [[nodiscard]] double frequency() const {
    const double k = strain > 0 ? tension() / kSpacing : stiffness;
    return 2 * std::sqrt(k / mass) * std::sin(phase() / 2);
  }
  /// [s]. The stiffest motion must be stable as well.
  [[nodiscard]] double step() const {
    return std::min(kPhase / frequency(), 0.3 / std::sqrt(stiffness / mass));
  }
};

double measured_frequency(const Row& row, double mass_factor) {
  SpringRow springs;
  springs.num_springs = row.is_free ? row.masses : row.masses + 1;
  springs.spacing = Row::kSpacing * (1 - row.strain);
  springs.mass = row.mass * mass_factor;
  springs.laws = {tension_law(row.stiffness)};
  const auto make = [&] {
    reference::Body body = make_row(springs);
    if (!row.is_free) body.mesh.pinned.push_back(springs.num_springs);
    body.positions *= 1 / (1 - row.strain);
    return body;
  };
  Matrix3X<double> mode = Matrix3X<double>::Zero(3, springs.num_springs + 1);
  const int axis = row.strain > 0 ? 1 : 0;
  for (int i = 1; i <= row.masses; ++i) mode(axis, i) = std::sin(row.phase() * i);
  return swing_frequency(make, mode, 1e-5 * Row::kSpacing, row.step(), kSteps);
}

void add_row_check(const CaseInfo& info, const std::string& what, const std::string& formula,
                   const Row& row, Report& report) {
  const double exact = row.frequency();
  CheckResult check =
      judged(info,
             {fmt::format("{}, {} masses, mode {}", what, row.masses, row.mode),
              "relative error of its frequency", formula, "eigenvalues of a row of springs",
              discrete_tolerance(row.frequency() * row.step()),
              "the tension law, the masses, or the integrator"},
             ComparedValue{"w", measured_frequency(row, 1.0), exact, "rad/s"});
  add_sabotage(check, "masses +1 %", std::abs(measured_frequency(row, 1.01) / exact - 1));
  report.checks.push_back(std::move(check));
}

void add_string_check(const CaseInfo& info, const Row& row, Report& report) {
  const double length = Row::kSpacing * (row.masses + 1);
  const double exact =
      row.mode * kPi / length * std::sqrt(row.tension() * Row::kSpacing / row.mass);
  CheckResult check = judged(
      info,
      {fmt::format("a chain of {} masses vibrates as a string, mode {}", row.masses, row.mode),
       "relative error of its frequency",
       "w = j pi c / L, c = sqrt(T / rho)",
       "vibrating string",
       {1e-3 * std::max(1.0, std::pow(row.phase() / 0.12, 2)), Basis::kTruncation,
        "(q a)^2 / 24, 0.06 % for q a = 0.12"},
       "the tension law, the masses, or the integrator"},
      ComparedValue{"w", measured_frequency(row, 1.0), exact, "rad/s"});
  const double mistake = mass_mistake(*check.tolerance);
  add_sabotage(check, fmt::format("masses {:+.3g} %", 100 * (mistake - 1)),
               std::abs(measured_frequency(row, mistake) / exact - 1));
  report.checks.push_back(std::move(check));
}

/// A square net under tension, m x n half waves.
struct Net {
  int cells = 32;
  int m = 1;
  int n = 1;
  static constexpr double kSide = 1.0;      // [m]
  static constexpr double kDensity = 0.2;   // [kg/m^2]
  static constexpr double kTension = 50.0;  // per width [N/m]
  static constexpr double kStrain = 0.2;

  [[nodiscard]] double spacing() const { return kSide / cells; }
  [[nodiscard]] double discrete() const {
    const double a = std::sin(kPi * m / (2 * cells));
    const double b = std::sin(kPi * n / (2 * cells));
    return std::sqrt(4 * kTension / (kDensity * spacing() * spacing()) * (a * a + b * b));
  }
  [[nodiscard]] double continuum() const {
    return kPi * std::sqrt(kTension / kDensity) * std::hypot(m, n) / kSide;
  }
  static constexpr double kStiffness =
      kTension / kStrain;  // per spring of width a: T a / (a strain)
  /// [s]. The stiffest motion must be stable as well.
  [[nodiscard]] double step() const {
    const double node_mass = kDensity * spacing() * spacing();
    return std::min(kPhase / discrete(), 0.3 / std::sqrt(kStiffness / node_mass));
  }
};

double measured_frequency(const Net& net, double mass_factor) {
  ClothGrid grid;
  grid.nodes = {net.cells + 1, net.cells + 1};
  grid.size = {Net::kSide * (1 - Net::kStrain), Net::kSide * (1 - Net::kStrain)};
  grid.stencil = GridStencil::k8Neighbour;
  grid.total_mass = mass_factor * Net::kDensity * Net::kSide * Net::kSide;
  const auto make = [&] {
    reference::Body body;
    body.name = "membrane";
    body.mesh = make_cloth_grid(grid);
    for (int i = 0; i <= net.cells; ++i) {
      for (int j = 0; j <= net.cells; ++j) {
        const bool is_rim = i == 0 || j == 0 || i == net.cells || j == net.cells;
        if (is_rim) body.mesh.pinned.push_back(grid_node(grid, i, j));
      }
    }
    std::sort(body.mesh.pinned.begin(), body.mesh.pinned.end());
    body.laws.add(forces::make_law<double>(
        {"tension", {"stretch"}, {{"stiffness", {Net::kStiffness}}}}, body.mesh));
    body.positions = body.mesh.rest_positions / (1 - Net::kStrain);
    body.velocities.setZero(3, body.mesh.num_nodes());
    return body;
  };
  Matrix3X<double> mode = Matrix3X<double>::Zero(3, (net.cells + 1) * (net.cells + 1));
  for (int i = 0; i <= net.cells; ++i) {
    for (int j = 0; j <= net.cells; ++j) {
      mode(1, grid_node(grid, i, j)) =
          std::sin(kPi * net.m * i / net.cells) * std::sin(kPi * net.n * j / net.cells);
    }
  }
  constexpr int kFewSteps = 600;
  return swing_frequency(make, mode, 1e-5 * net.spacing(), net.step(), kFewSteps);
}

void add_net_checks(const CaseInfo& info, const Net& net, Report& report) {
  const double measured = measured_frequency(net, 1.0);
  const double wave = kPi * std::max(net.m, net.n) / net.cells;  // from node to node [rad]
  const Tolerance continuum{std::max(1e-3, wave * wave / 16), Basis::kTruncation,
                            "second order in the spacing: at most (q a)^2 / 24"};
  const double mistake = mass_mistake(continuum);
  const double sabotaged = measured_frequency(net, mistake);
  const auto add = [&](const std::string& claim, const std::string& formula, double exact,
                       const Tolerance& tolerance) {
    CheckResult check = judged(
        info,
        {fmt::format("{}, {} x {} cells, mode ({}, {})", claim, net.cells, net.cells, net.m, net.n),
         "relative error of its frequency", formula, "vibrating membrane", tolerance,
         "the tension law, the masses, or the integrator"},
        ComparedValue{"w", measured, exact, "rad/s"});
    add_sabotage(check, fmt::format("masses {:+.3g} %", 100 * (mistake - 1)),
                 std::abs(sabotaged / exact - 1));
    report.checks.push_back(std::move(check));
  };
  add("a net of springs vibrates as its own formula says",
      "w^2 = 4 T / (rho a^2) (sin^2(pi m a / 2 L) + sin^2(pi n a / 2 L))", net.discrete(),
      discrete_tolerance(net.discrete() * net.step()));
  add("a net of springs vibrates as a membrane", "w = pi sqrt(T / rho) sqrt(m^2 + n^2) / L",
      net.continuum(), continuum);
}

/// beta^2 of a clamped strip: w = beta^2 sqrt(D / (rho L^4)).
constexpr std::array kStripModes = {3.516015, 22.034492, 61.697214};

/// The first modes of a clamped strip without gravity, w / sqrt(D / (rho L^4)).
std::vector<double> strip_modes(int cells, double clamp_factor, int count) {
  Strip strip;
  strip.num_cells = cells;
  reference::Body body;
  body.name = "strip";
  body.mesh = make_strip(strip);
  constexpr double kRigidity = 1e-5;  // D [N m]
  // So stiff in its plane that the third bending mode is slower than the first one in the plane.
  const double stretch = 1e8 * kRigidity / (strip.length * strip.length);
  for (const forces::LawSpecification& law : std::vector<forces::LawSpecification>{
           {"tension", {}, {{"stiffness", {stretch}}}},
           {"hinge_torsion", {}, {{"rigidity", {kRigidity}}, {"clamp_factor", {clamp_factor}}}}}) {
    body.laws.add(forces::make_law<double>(law, body.mesh));
  }
  const double weight = kRigidity / strip.length;
  const reference::StaticProblem problem = reference::static_problem(body, weight);
  std::vector<double> frequencies;
  const double unit = std::sqrt(kRigidity / strip.area_density) / (strip.length * strip.length);
  for (const Mode& mode :
       slowest_modes(problem, body.mesh.rest_positions, body.mesh.masses, count, strip.length)) {
    frequencies.push_back(std::sqrt(mode.omega_squared) / unit);
  }
  return frequencies;
}

void add_strip_checks(const CaseInfo& info, int cells, int count, Report& report) {
  const std::vector<double> right = strip_modes(cells, 2.0, count);
  const std::vector<double> wrong = strip_modes(cells, 1.0, count);
  for (int mode = 0; mode < count; ++mode) {
    const auto m = static_cast<std::size_t>(mode);
    const auto mode_of = [&](const std::vector<double>& list) {
      return ComparedValue{"w sqrt(rho L^4 / D)", m < list.size() ? list[m] : std::nan(""),
                           kStripModes[m], "1"};
    };
    CheckResult check = judged(
        info,
        {fmt::format("a clamped strip of {} cells vibrates as a beam, mode {}", cells, mode + 1),
         "relative error of its frequency",
         "w = beta^2 sqrt(D / (rho L^4)), cos beta cosh beta = -1",
         "Euler-Bernoulli cantilever; the strip's mode by inverse iteration",
         {1e-3 * std::max(1.0, std::pow(120.0 / cells, 2)), Basis::kTruncation,
          "second order in the cells: 0.1 % from 120 cells on"},
         "hinge_torsion and its clamp, or the masses",
         "reference statics"},
        mode_of(right));
    add_sabotage(check, "hinges at the clamp not doubled", relative_error(mode_of(wrong)));
    report.checks.push_back(std::move(check));
  }
}

constexpr std::array kParameters = {
    CaseParameter{"masses", "1", "of the row", 1, 500, 50, true},
    CaseParameter{"mode", "1", "of the row, and of the membrane along both sides", 1, 20, 1, true},
    CaseParameter{"cells", "1", "of the membrane, along a side", 4, 64, 32, true},
    CaseParameter{"nodes", "1", "cells of the strip along its length", 30, 160, 120, true},
};

}  // namespace
}  // namespace frequencies

std::span<const CaseParameter> frequencies_parameters() {
  using namespace frequencies;
  return kParameters;
}

void evaluate_frequencies(const CaseInfo& info, const CaseOptions& options, const EngineRuns&,
                          Report& report) {
  using namespace frequencies;
  const std::string axial = "w = 2 sqrt(k / m) sin((2 j - 1) pi / (2 (2 N + 1)))";
  const std::string between = "w = 2 sqrt(k / m) sin(j pi / (2 (N + 1)))";
  const std::string beaded = "w = 2 sqrt(T / (m a)) sin(j pi / (2 (N + 1)))";
  if (asks_for_point(options)) {
    const auto whole = [&](const char* name) {
      return static_cast<int>(value_of(info, options, name));
    };
    Row row{.masses = whole("masses"), .mode = std::min(whole("mode"), whole("masses"))};
    add_row_check(info, "a chain between two walls vibrates along itself", between, row, report);
    row.strain = 0.2;
    add_row_check(info, "a beaded string vibrates across itself", beaded, row, report);
    add_string_check(info, row, report);
    const int mode = std::min(whole("mode"), whole("cells") / 2);
    add_net_checks(info, {.cells = whole("cells"), .m = mode, .n = mode}, report);
    add_strip_checks(info, whole("nodes"), 3, report);
    return;
  }
  for (const int mode : {1, 2, 7}) {
    add_row_check(info, "a chain with a free end vibrates along itself", axial,
                  {.mode = mode, .is_free = true}, report);
    add_row_check(info, "a chain between two walls vibrates along itself", between, {.mode = mode},
                  report);
    add_row_check(info, "a beaded string vibrates across itself", beaded,
                  {.mode = mode, .strain = 0.2}, report);
  }
  add_string_check(info, {.masses = 50, .mode = 1, .strain = 0.2}, report);
  add_string_check(info, {.masses = 150, .mode = 2, .strain = 0.2}, report);
  add_net_checks(info, {}, report);
  add_net_checks(info, {.cells = 56, .m = 2, .n = 1}, report);
  add_strip_checks(info, 120, 3, report);
}

}  // namespace weft::validation
