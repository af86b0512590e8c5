// A sheet falls through still air at sqrt(2 m g / (rho C_n A)), and hovers in a wind of that speed.
// Tested by tests/apps/CMakeLists.txt.
#include <cmath>

#include <weft/custom_forces/registry.hpp>
#include <weft/mesh/cloth_grid.hpp>
#include <weft/validation/cases/support/analytic_cases.hpp>
#include <weft/validation/cases/support/closed_form_check.hpp>
#include <weft/validation/cases/support/small_systems.hpp>

namespace weft::validation {
namespace hover {
namespace {

constexpr double kSide = 0.6;           // [m]
constexpr double kArealDensity = 0.15;  // [kg/m^2]: light cotton
constexpr double kDensity = 1.2;        // of the air [kg/m^3]
constexpr double kNormalDrag = 1.1;     // [-]
constexpr double kGravity = 9.81;       // [m/s^2]
constexpr double kTimeStep = 1e-3;      // [s]: half of the stable step
constexpr double kEndTime = 2.0;        // [s]: 25 times u / (2 g), in which the speed settles
constexpr int kBisections = 8;          // of 0.3 m/s: to 1.2 mm/s, 0.08 %

struct Sheet {
  bool exactly_flat = false;  ///< masses in proportion to the drag of each node
  double density = kDensity;  ///< that the law is told [kg/m^3]
};

/// Speed at which drag carries the weight [m/s].
double terminal_speed() {
  return std::sqrt(2 * kArealDensity * kGravity / (kDensity * kNormalDrag));
}

/// Mean vertical velocity of the sheet's mass at the end, in an upward wind [m/s].
double final_velocity(const Sheet& sheet, double wind) {
  ClothGrid grid;
  grid.nodes = {9, 9};
  grid.size = {kSide, kSide};
  grid.total_mass = kArealDensity * kSide * kSide;
  grid.stencil = GridStencil::k8Neighbour;
  grid.lumping = MassLumping::kArea;
  reference::Body body;
  body.name = "sheet";
  body.mesh = make_cloth_grid(grid);
  if (sheet.exactly_flat) body.mesh.masses = kArealDensity * node_areas(body.mesh);
  for (const forces::LawSpecification& law :
       {tension_law(25.0), spring_damping_law(0.01), gravity_law({0, -kGravity, 0}),
        forces::LawSpecification{"hinge_torsion", {}, {{"rigidity", {1e-3}}}},
        forces::LawSpecification{"wind",
                                 {},
                                 {{"velocity", {0, wind, 0}},
                                  {"air_density", {sheet.density}},
                                  {"normal_drag", {kNormalDrag}}}}}) {
    body.laws.add(forces::make_law<double>(law, body.mesh));
  }
  body.positions = body.mesh.rest_positions;
  body.velocities.setZero(3, body.mesh.num_nodes());
  reference::SpringSolver solver =
      make_solver(std::move(body), reference::IntegratorKind::kModifiedEuler);
  const int num_steps = static_cast<int>(std::lround(kEndTime / kTimeStep));
  for (int step = 0; step < num_steps; ++step) (void)solver.step(kTimeStep);
  const reference::Body& end = solver.system().bodies[0];
  return (end.velocities * end.mesh.masses).y() / end.mesh.masses.sum();
}

/// The upward wind in which the sheet neither rises nor falls [m/s].
double hover_speed(const Sheet& sheet) {
  double low = terminal_speed() - 0.15;
  double high = terminal_speed() + 0.15;
  for (int i = 0; i < kBisections; ++i) {
    const double middle = 0.5 * (low + high);
    (final_velocity(sheet, middle) < 0 ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

ComparedValue fall_speed(const Sheet& sheet) {
  return {"speed after 2 s", -final_velocity(sheet, 0.0), terminal_speed(), "m/s"};
}

ComparedValue hover_wind(const Sheet& sheet) {
  return {"wind", hover_speed(sheet), terminal_speed(), "m/s"};
}

CheckResult check_of(const CaseInfo& info, const Tolerance& tolerance,
                     ComparedValue (*speed)(const Sheet&), const Sheet& right) {
  CheckResult check;
  check.case_id = info.id;
  check.engine = "reference";
  check.unit = "1";
  check.formula = "u = sqrt(2 m g / (rho C_n A))";
  check.source = "weight = quadratic drag";
  check.values = {speed(right)};
  check.measured = relative_error(check.values[0]);
  check.tolerance = tolerance;
  check.verdict = judge(check.measured, tolerance);
  Sheet wrong = right;
  wrong.density *= 1.1;
  const double sabotaged = relative_error(speed(wrong));
  check.sabotages.push_back(
      {"density of the air +10 %", sabotaged, judge(sabotaged, tolerance) == Verdict::kFail});
  check.note = "the wind law, the area or the mass of the sheet, or it does not lie flat";
  return check;
}

Plot velocity_plot(const Sheet& sheet) {
  Plot plot{"Vertical velocity of the sheet against the wind from below",
            "wind [m/s]",
            "velocity after 2 s [m/s]",
            false,
            false,
            {{"measured", {}, {}}, {"wind - u", {}, {}}}};
  for (int i = 0; i <= 8; ++i) {
    const double wind = 0.25 * i * terminal_speed();
    for (Series& series : plot.series) series.x.push_back(wind);
    plot.series[0].y.push_back(final_velocity(sheet, wind));
    plot.series[1].y.push_back(wind - terminal_speed());
  }
  return plot;
}

}  // namespace
}  // namespace hover

void evaluate_hover(const CaseInfo& info, const CaseOptions&, const EngineRuns&, Report& report) {
  using namespace hover;
  const Sheet flat{.exactly_flat = true};
  const Sheet bent;  // masses by the area of cells, drag by that of triangles: it bends a little

  CheckResult fall = check_of(
      info,
      {1e-9, Basis::kTruncation, "what tanh(g t / u) still lacks after 2 s is exp(-26) = 5e-12"},
      &fall_speed, flat);
  fall.claim = "a flat sheet falls through still air at its terminal speed";
  fall.metric = "relative error of the speed after 2 s";
  report.checks.push_back(std::move(fall));

  CheckResult hover =
      check_of(info,
               {0.02, Basis::kModelGap,
                "the formula is for a flat sheet; the masses of this one bend it a little"},
               &hover_wind, bent);
  hover.claim = "a sheet hovers in an upward wind of its terminal speed";
  hover.metric = "relative error of the wind in which it neither rises nor falls";
  report.checks.push_back(std::move(hover));

  Section section{std::string(info.id), std::string(info.summary), {}, {}, {}, ""};
  section.plots.push_back(velocity_plot(bent));
  report.sections.push_back(std::move(section));
}

}  // namespace weft::validation
