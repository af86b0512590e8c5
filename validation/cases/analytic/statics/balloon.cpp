// A balloon of springs: its pressure curve, and the pressure above which it has no equilibrium.
// Tested by tests/validation/theory_test.cpp.
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <weft/custom_forces/laws/external/pressure.hpp>
#include <weft/custom_forces/registry.hpp>
#include <weft/mesh/icosphere.hpp>
#include <weft/validation/cases/support/analytic_cases.hpp>
#include <weft/validation/cases/support/closed_form_check.hpp>
#include <weft/validation/cases/support/parameters.hpp>
#include <weft/validation/cases/support/small_systems.hpp>

namespace weft::validation {
namespace balloon {
namespace {

constexpr double kRadius = 1.0;       // R0 [m]
constexpr double kStiffness = 100.0;  // k [N/m]
constexpr int kFrequency = 8;         // 642 nodes: sum of l0^2 is 0.7 % over that of a lattice
constexpr double kNodeMass = 0.12;    // [kg]: the fastest mode turns by 0.7 rad per step
constexpr double kTimeStep = 0.01;    // [s]
constexpr double kDamping = 5.0;      // [1/s]: the breathing mode (5 rad/s) settles fastest

/// dp R0 / k of a triangular lattice of springs, stretched by 1 + e.
double lattice_load(double e) {
  return 2 * std::sqrt(3.0) * e / ((1 + e) * (1 + e));
}

class Balloon {
 public:
  struct Setup {
    double pressure = 0.0;   ///< p0 [Pa]
    double reservoir = 0.0;  ///< V_r [m^3]
    double stiffness = kStiffness;
    double first_stretch = 0.0;  ///< e at the start
    double hidden = 0.0;         ///< sabotage: outside pressure that no formula knows of [Pa]
  };

  explicit Balloon(const Setup& setup) : Balloon(setup, mesh()) {}

  void step() { (void)solver_.step(kTimeStep); }
  /// e = (V / V0)^(1/3) - 1.
  [[nodiscard]] double stretch() const { return std::cbrt(volume() / rest_volume_) - 1; }
  /// Growth of the mean radius [m/s].
  [[nodiscard]] double growth() const {
    const reference::Body& body = solver_.system().bodies[0];
    return body.positions.colwise().normalized().cwiseProduct(body.velocities).sum() /
           static_cast<double>(body.mesh.num_nodes());
  }
  [[nodiscard]] double largest_speed() const {
    return solver_.system().bodies[0].velocities.colwise().norm().maxCoeff();
  }
  [[nodiscard]] double volume() const {
    const reference::Body& body = solver_.system().bodies[0];
    return gas_.volume({body.positions, body.velocities, body.mesh.masses});
  }
  /// p [Pa].
  [[nodiscard]] double load() const {
    return setup_.pressure * (rest_volume_ + setup_.reservoir) / (volume() + setup_.reservoir);
  }
  /// Sum over springs of force times length over 3 p V: 1 in every equilibrium, whatever the mesh.
  [[nodiscard]] double virial_ratio() const {
    const reference::Body& body = solver_.system().bodies[0];
    const Edges& edges = body.mesh.edge_sets[0].edges;
    const VectorX<double> rest = edge_lengths(body.mesh.rest_positions, edges);
    const VectorX<double> now = edge_lengths(body.positions, edges);
    return setup_.stiffness * (now - rest).dot(now) / (3 * load() * volume());
  }

 private:
  static ClothMesh mesh() {
    ClothMesh mesh = make_icosphere({.radius = kRadius, .frequency = kFrequency});
    mesh.masses.setConstant(kNodeMass);
    mesh.edge_sets.resize(1);  // the theory's lattice has springs along the edges only
    return mesh;
  }
  static forces::LawSpecification gas_law(const Setup& setup) {
    return {"pressure",
            {},
            {{"pressure", {setup.pressure}},
             {"outside_pressure", {setup.hidden}},
             {"reservoir_volume", {setup.reservoir}}}};
  }
  static reference::Body body(const Setup& setup, const ClothMesh& mesh) {
    reference::Body body;
    body.name = "balloon";
    body.mesh = mesh;
    for (const forces::LawSpecification& law :
         {tension_law(setup.stiffness), gas_law(setup), velocity_damping_law(kDamping)}) {
      body.laws.add(forces::make_law<double>(law, body.mesh));
    }
    body.positions = (1 + setup.first_stretch) * mesh.rest_positions;
    body.velocities.setZero(3, mesh.num_nodes());
    return body;
  }
  Balloon(const Setup& setup, const ClothMesh& mesh)
      : setup_(setup),
        gas_(forces::checked(gas_law(setup)), mesh),
        rest_volume_(gas_.volume(
            {mesh.rest_positions, Matrix3X<double>::Zero(3, mesh.num_nodes()), mesh.masses})),
        solver_(make_solver(body(setup, mesh), reference::IntegratorKind::kModifiedEuler)) {}

  Setup setup_;
  forces::Pressure<double> gas_;
  double rest_volume_;
  reference::SpringSolver solver_;
};

struct Equilibrium {
  double stretch;  ///< e
  double load;     ///< dp R0 / k, with the k of the theory
  double virial;
};

/// The state in which a fixed amount of gas comes to rest. Gas that shares its volume with nothing
/// loses pressure faster than the springs, so that the falling branch e > 1 is stable as well.
Equilibrium inflated(double target, double stiffness_factor, double hidden = 0.0) {
  const double cube = (1 + target) * (1 + target) * (1 + target);
  Balloon balloon({.pressure = lattice_load(target) * kStiffness / kRadius * cube,
                   .stiffness = stiffness_factor * kStiffness,
                   .first_stretch = target,
                   .hidden = hidden});
  // Speeds of 1e-9 m/s mean forces of about m gamma v = 1e-9 N, next to 1 N in a spring.
  constexpr double kAtRest = 1e-9;  // [m/s]
  constexpr int kMaxSteps = 4000;
  constexpr int kSettle = 50;  // it starts at rest, but not in equilibrium
  for (int step = 0; step < kMaxSteps; ++step) {
    balloon.step();
    if (step > kSettle && balloon.largest_speed() < kAtRest) break;
  }
  return {balloon.stretch(), balloon.load() * kRadius / kStiffness, balloon.virial_ratio()};
}

/// Whether the balloon grows without end under a constant pressure. It starts just below the
/// stretch of the largest load.
bool bursts(double load, double stiffness_factor) {
  Balloon balloon({.pressure = load * kStiffness / kRadius,
                   .reservoir = 1e9,
                   .stiffness = stiffness_factor * kStiffness,
                   .first_stretch = 0.9});
  constexpr double kBurst = 1.3;  // past the top of the curve
  // It creeps through the top in 2 pi / sqrt(x) / 4 s for a load of a fraction x above the limit.
  constexpr int kMaxSteps = 3000;
  constexpr int kSettle = 100;
  for (int step = 0; step < kMaxSteps; ++step) {
    balloon.step();
    if (step < kSettle) continue;
    if (balloon.stretch() > kBurst) return true;
    if (balloon.growth() < 0) return false;  // on its way back to an equilibrium
  }
  return false;
}

double limit_load(double stiffness_factor) {
  double low = 0.80;
  double high = 0.95;
  constexpr int kBisections = 6;  // to 0.0012
  for (int i = 0; i < kBisections; ++i) {
    const double middle = 0.5 * (low + high);
    (bursts(middle, stiffness_factor) ? high : low) = middle;
  }
  return 0.5 * (low + high);
}

const std::vector<double> kTargets = {0.05, 0.1, 0.2, 0.5, 1.0, 1.5};

struct Curve {
  Series series{"measured", {}, {}};
  double largest_error = 0;
  ComparedValue worst = {};
  double largest_virial = 0;
  double worst_virial = 1;
};

Curve measured_curve(double stiffness_factor, const std::vector<double>& targets) {
  Curve curve;
  for (const double target : targets) {
    const Equilibrium e = inflated(target, stiffness_factor);
    curve.series.x.push_back(e.stretch);
    curve.series.y.push_back(e.load);
    const ComparedValue pair{fmt::format("dp R0 / k at e = {:.4g}", e.stretch), e.load,
                             lattice_load(e.stretch), "1"};
    // Not a number is the largest of all.
    if (!(relative_error(pair) <= curve.largest_error)) {
      curve.largest_error = relative_error(pair);
      curve.worst = pair;
    }
    if (!(std::abs(e.virial - 1) <= curve.largest_virial)) {
      curve.largest_virial = std::abs(e.virial - 1);
      curve.worst_virial = e.virial;
    }
  }
  return curve;
}

CheckResult check_of(const CaseInfo& info, std::string claim, std::string metric,
                     std::string formula) {
  CheckResult check;
  check.case_id = info.id;
  check.engine = "reference";
  check.claim = std::move(claim);
  check.metric = std::move(metric);
  check.unit = "1";
  check.formula = std::move(formula);
  return check;
}

void judge_with(CheckResult& check, const Tolerance& tolerance, double right, double wrong,
                const std::string& sabotage) {
  check.measured = right;
  check.tolerance = tolerance;
  check.verdict = judge(right, tolerance);
  check.sabotages.push_back({sabotage, wrong, judge(wrong, tolerance) == Verdict::kFail});
}

constexpr std::array kParameters = {
    CaseParameter{"stretch", "1", "e = R / R0 - 1 of the balloon", 0.02, 2.0, 0.5},
};

}  // namespace
}  // namespace balloon

std::span<const CaseParameter> balloon_parameters() {
  using namespace balloon;
  return kParameters;
}

void evaluate_balloon(const CaseInfo& info, const CaseOptions& options, const EngineRuns&,
                      Report& report) {
  using namespace balloon;
  constexpr double kWrong = 1.03;
  const std::string sabotage = "spring constant +3 %";
  const Tolerance one_percent{
      0.01, Basis::kTruncation,
      "the icosphere of 642 nodes is no lattice of equal triangles: the sum "
      "of its squared edges is 0.7 % larger for the same area"};
  const std::vector<double> targets =
      asks_for_point(options) ? std::vector<double>{value_of(info, options, "stretch")} : kTargets;
  const Curve right = measured_curve(1.0, targets);
  const Curve wrong = measured_curve(kWrong, targets);

  CheckResult curve =
      check_of(info, "a balloon of springs follows the pressure curve of the lattice",
               fmt::format("largest relative error of the pressure, e = {} to {}", targets.front(),
                           targets.back()),
               "dp R0 / k = 2 sqrt(3) e / (1 + e)^2, e = (V / V0)^(1/3) - 1");
  curve.source = "Laplace's law with the tension sqrt(3) k e / (1 + e) of a triangular lattice";
  curve.note = "the pressure law, the tension law, or the balloon has not come to rest";
  judge_with(curve, one_percent, right.largest_error, wrong.largest_error, sabotage);
  curve.values = {right.worst};
  report.checks.push_back(std::move(curve));

  CheckResult virial =
      check_of(info, "springs and gas balance, on this very mesh",
               "largest |sum of force times length / (3 p V) - 1|", "sum k (l - l0) l = 3 p V");
  virial.source = "virial theorem of an equilibrium: exact for any mesh";
  virial.note = "the balloon has not come to rest, or the force is not p dV/dx";
  judge_with(virial,
             {1e-8, Basis::kRoundoff, "what is left of the motion: forces of 1e-9 of a spring's"},
             right.largest_virial, std::abs(inflated(1.0, 1.0, 1.0).virial - 1),
             "outside pressure of 1 Pa");
  virial.values = {{"sum of force times length / (3 p V)", right.worst_virial, 1.0, "1"}};
  report.checks.push_back(std::move(virial));
  if (asks_for_point(options)) return;

  CheckResult limit = check_of(info, "above its limit load the balloon has no equilibrium",
                               "relative error of the largest constant pressure that it bears",
                               "dp R0 / k = sqrt(3) / 2, at e = 1");
  limit.source = "maximum of the pressure curve";
  limit.note = "the reservoir, or the springs soften or stiffen too early";
  const auto largest = [](double factor) {
    return ComparedValue{"largest dp R0 / k", limit_load(factor), lattice_load(1.0), "1"};
  };
  limit.values = {largest(1.0)};
  judge_with(limit, one_percent, relative_error(limit.values[0]), relative_error(largest(kWrong)),
             sabotage);
  report.checks.push_back(std::move(limit));

  Series theory{"2 sqrt(3) e / (1 + e)^2", {}, {}};
  for (int i = 0; i <= 40; ++i) {
    theory.x.push_back(0.05 * i);
    theory.y.push_back(lattice_load(0.05 * i));
  }
  Section section{std::string(info.id), std::string(info.summary), {}, {}, {}, ""};
  section.plots.push_back({"Pressure of the balloon against its stretch",
                           "e = R / R0 - 1 [1]",
                           "dp R0 / k [1]",
                           false,
                           false,
                           {right.series, theory}});
  report.sections.push_back(std::move(section));
}

}  // namespace weft::validation
