// The added inertia: periods and stable steps grow by sqrt(1 + beta), free fall and the static shape
// stay.
// Tested by tests/apps/CMakeLists.txt.
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <weft/custom_forces/registry.hpp>
#include <weft/validation/cases/support/analytic_cases.hpp>
#include <weft/validation/cases/support/closed_form_check.hpp>
#include <weft/validation/cases/support/small_systems.hpp>
#include <weft/validation/cases/support/stable_step_search.hpp>

namespace weft::validation {
namespace acceleration_damping {
namespace {

using reference::IntegratorKind;
using LawPointer = std::unique_ptr<forces::ForceLaw<double>>;

constexpr double kBetas[] = {0.5, 1.0, 3.0};  // [-]

LawPointer right_law(double beta, const ClothMesh& mesh) {
  return forces::make_law<double>(acceleration_damping_law(beta), mesh);
}

/// A law with another redistribution under the right law's name.
class WrongInertia : public forces::ForceLaw<double> {
 public:
  [[nodiscard]] const forces::LawInfo& info() const noexcept override {
    return *forces::find_law("acceleration_damping");
  }
  void add_forces(const forces::State<double>&, Matrix3XRef<double>,
                  Matrix3XRef<double>) const override {}
};

/// Mistake: the force -beta m a with the acceleration of the step before.
class PreviousAcceleration final : public WrongInertia {
 public:
  PreviousAcceleration(double beta, const ClothMesh& mesh)
      : beta_(beta), previous_(Matrix3X<double>::Zero(3, mesh.num_nodes())) {}

  void redistribute_forces(const forces::State<double>& state,
                           Matrix3XRef<double> forces) const override {
    forces -= beta_ * previous_ * state.masses.asDiagonal();
    const Vector3<double> center = forces.rowwise().sum() / state.masses.sum();
    previous_ = (forces * state.masses.cwiseInverse().asDiagonal()).colwise() - center;
  }

 private:
  double beta_;
  mutable Matrix3X<double> previous_;  // relative to the centre of mass [m/s^2]
};

/// Mistake: the motion of the centre of mass is slowed down too.
class InertiaOfAll final : public WrongInertia {
 public:
  explicit InertiaOfAll(double beta) : beta_(beta) {}
  void redistribute_forces(const forces::State<double>&,
                           Matrix3XRef<double> forces) const override {
    forces /= 1 + beta_;
  }

 private:
  double beta_;
};

using MakeLaw = std::function<LawPointer(double beta, const ClothMesh& mesh)>;

LawPointer previous_acceleration(double beta, const ClothMesh& mesh) {
  return std::make_unique<PreviousAcceleration>(beta, mesh);
}

LawPointer inertia_of_all(double beta, const ClothMesh&) {
  return std::make_unique<InertiaOfAll>(beta);
}

LawPointer one_percent_more(double beta, const ClothMesh& mesh) {
  return right_law(1.01 * beta, mesh);
}

// A dumbbell that falls and drifts while it swings.
constexpr double kMasses[] = {0.2, 0.5};  // [kg]
constexpr double kStiffness = 40.0;       // [N/m]
constexpr double kTimeStep = 0.02;        // [s]: omega h = 0.33
constexpr int kNumSteps = 1000;

/// Elongations d_0 to d_n [m] of the dumbbell, let go at d_0 = 0.1 m.
std::vector<double> elongations(IntegratorKind integrator, double beta, const MakeLaw& make) {
  SpringBody springs;
  springs.positions = Matrix3X<double>::Zero(3, 2);
  springs.positions(0, 1) = 1.0;
  springs.edges = Edges{{0}, {1}};
  springs.masses = Eigen::Vector2d(kMasses[0], kMasses[1]);
  springs.laws = {tension_law(kStiffness), gravity_law({0.1, 0, 0})};
  reference::Body body = make_body(springs);
  if (beta > 0) body.laws.add(make(beta, body.mesh));
  body.positions(0, 1) += 0.1;
  body.velocities.row(0).setConstant(0.3);
  reference::SpringSolver solver = make_solver(std::move(body), integrator);
  const reference::Body& now = solver.system().bodies[0];
  std::vector<double> d;
  for (int step = 0; step <= kNumSteps; ++step) {
    d.push_back(now.positions(0, 1) - now.positions(0, 0) - 1.0);
    (void)solver.step(kTimeStep);
  }
  return d;
}

/// w h / 2 [-] without the law.
double half_phase() {
  const double reduced_mass = kMasses[0] * kMasses[1] / (kMasses[0] + kMasses[1]);
  return 0.5 * kTimeStep * std::sqrt(kStiffness / reduced_mass);
}

/// Phase per step [rad] from the three-term recurrence d_(n+1) + d_(n-1) = 2 cos(phase) d_n, by
/// least squares.
double phase_per_step(IntegratorKind integrator, double beta, const MakeLaw& make) {
  const std::vector<double> d = elongations(integrator, beta, make);
  double sum = 0, squares = 0;
  for (std::size_t n = 1; n + 1 < d.size(); ++n) {
    sum += d[n] * (d[n - 1] + d[n + 1]);
    squares += 2 * d[n] * d[n];
  }
  return std::acos(sum / squares);
}

/// Largest error of an elongation of modified Euler over the amplitude.
double path_error(double beta, const MakeLaw& make) {
  const std::vector<double> d = elongations(IntegratorKind::kModifiedEuler, beta, make);
  const double phase = 2 * std::asin(half_phase() / std::sqrt(1 + beta));
  const double amplitude = d[0] / std::cos(phase / 2);
  double worst = 0;
  for (std::size_t n = 0; n < d.size(); ++n) {
    const double exact = amplitude * std::cos((static_cast<double>(n) + 0.5) * phase);
    const double error = std::abs(d[n] - exact) / amplitude;
    if (!std::isfinite(error)) return error;
    worst = std::max(worst, error);
  }
  return worst;
}

/// Largest relative error of the ratio of periods, over all beta.
double period_error(IntegratorKind integrator, const MakeLaw& make) {
  const double half = half_phase();
  const double plain = phase_per_step(integrator, 0.0, make);
  double worst = 0;
  for (const double beta : kBetas) {
    const double exact = std::asin(half) / std::asin(half / std::sqrt(1 + beta));
    const double error = plain / phase_per_step(integrator, beta, make) / exact - 1;
    if (!(std::abs(error) <= worst)) worst = std::abs(error);
    if (!std::isfinite(worst)) return worst;
  }
  return worst;
}

void check_periods(const CaseInfo& info, Report& report) {
  for (const IntegratorKind integrator :
       {IntegratorKind::kModifiedEuler, IntegratorKind::kVelocityVerlet}) {
    CheckResult check =
        judged(info,
               {"a free dumbbell swings sqrt(1 + beta) times as long with " +
                    std::string(name_of(integrator)) + ", beta = 0.5, 1, 3",
                "largest relative error of the ratio of periods",
                "T(beta) / T(0) = asin(w h / 2) / asin(w h / (2 sqrt(1 + beta)))",
                "both schemes: d_(n+1) - 2 d_n + d_(n-1) = -h^2 w^2 / (1 + beta) d_n",
                {1e-9, Basis::kRoundoff,
                 "rounding of positions up to 20 m, 1e-14 of the elongation per step, over the "
                 "phase of 0.1 per step; a wrong beta shows at 1e-3"},
                "the redistribution of forces, or where the integrator applies it"},
               period_error(integrator, right_law));
    add_sabotage(check, "beta +1 %", period_error(integrator, one_percent_more));
    add_sabotage(check, "acceleration of the step before",
                 period_error(integrator, previous_acceleration));
    report.checks.push_back(std::move(check));
  }
}

void check_amplitude(const CaseInfo& info, Report& report) {
  const auto worst = [](const MakeLaw& make) {
    return std::max({path_error(0.5, make), path_error(1.1, make), path_error(2.0, make)});
  };
  CheckResult check = judged(
      info,
      {"and keeps its amplitude, step for step, beta = 0.5, 1.1, 2",
       "largest error of an elongation over the amplitude, 1000 steps",
       "d_n = d_0 cos((n + 1/2) p) / cos(p / 2), sin(p / 2) = w h / (2 sqrt(1 + beta))",
       "recurrence of modified Euler from rest; an inertia takes no energy",
       {1e-9, Basis::kRoundoff,
        "rounding of positions up to 80 m, 1e-13 of the elongation per step, over 1000 steps"},
       "the redistribution of forces; fed with the acceleration of the step before it multiplies "
       "errors by -beta per step, which explodes for beta > 1"},
      worst(right_law));
  add_sabotage(check, "acceleration of the step before, beta = 0.9",
               path_error(0.9, previous_acceleration));
  add_sabotage(check, "acceleration of the step before, beta = 1.1",
               path_error(1.1, previous_acceleration));
  add_sabotage(check, "acceleration of the step before, beta = 2",
               path_error(2.0, previous_acceleration));
  report.checks.push_back(std::move(check));
}

/// Largest relative error of the path of each node of a cloth in free fall, 500 steps.
double fall_error(const MakeLaw& make) {
  constexpr double kGravity = 9.81;  // [m/s^2]
  constexpr double kStep = 1e-3;     // [s]
  constexpr int kSteps = 500;
  reference::Body body = floating_cloth(0.0);
  body.laws.add(forces::make_law<double>(gravity_law({0, -kGravity, 0}), body.mesh));
  body.laws.add(make(2.0, body.mesh));
  const Matrix3X<double> start = body.positions;
  reference::SpringSolver solver = make_solver(std::move(body), IntegratorKind::kModifiedEuler);
  for (int step = 0; step < kSteps; ++step) (void)solver.step(kStep);
  Matrix3X<double> error = solver.system().bodies[0].positions - start;
  const double path = kGravity * kStep * kStep * kSteps * (kSteps + 1) / 2;
  error.row(1).array() += path;
  return error.cwiseAbs().maxCoeff() / path;
}

void check_free_fall(const CaseInfo& info, Report& report) {
  CheckResult check =
      judged(info,
             {"a cloth in free fall falls as without it",
              "largest error of a node's path over the path",
              "h^2 g n (n + 1) / 2",
              "modified Euler under a uniform field",
              {1e-9, Basis::kRoundoff, "500 steps, each with a rounding of 1e-16 of 1 m"},
              "the centre of mass in the redistribution"},
             fall_error(right_law));
  add_sabotage(check, "inertia of the centre of mass too", fall_error(inertia_of_all));
  report.checks.push_back(std::move(check));
}

/// Relative error of the tip's drop of a chain of 10 masses with beta = 2 at rest.
ComparedValue chain_drop(double stiffness_factor) {
  constexpr int kNumMasses = 10;
  constexpr double kMass = 0.1, kSpring = 1000.0, kGravity = 9.81, kBeta = 2.0;
  constexpr double kStep = 1e-3, kEnd = 12.0;  // [s]: the slowest mode decays by exp(-30)
  const double pi = std::acos(-1.0);
  const double slowest = 2 * std::sqrt(kSpring / kMass) * std::sin(pi / (2 * (2 * kNumMasses + 1)));
  SpringRow row;
  row.num_springs = kNumMasses;
  row.spacing = 0.1;
  row.mass = kMass;
  row.direction = {0, -1, 0};
  row.laws = {tension_law(stiffness_factor * kSpring), gravity_law({0, -kGravity, 0}),
              velocity_damping_law(2 * slowest), acceleration_damping_law(kBeta)};
  reference::SpringSolver solver =
      make_solver(make_row(row), reference::IntegratorKind::kModifiedEuler);
  for (int step = 0; step < std::lround(kEnd / kStep); ++step) (void)solver.step(kStep);
  const reference::Body& body = solver.system().bodies[0];
  const double drop = body.mesh.rest_positions(1, kNumMasses) - body.positions(1, kNumMasses);
  return {"drop of the tip", drop, kMass * kGravity * kNumMasses * (kNumMasses + 1) / (2 * kSpring),
          "m"};
}

void check_static_shape(const CaseInfo& info, Report& report) {
  CheckResult check = judged(
      info,
      {"a chain of 10 masses hangs as without it",
       "relative error of the tip's drop",
       "m g N (N + 1) / (2 k)",
       "statics of a hanging chain of springs",
       {1e-9, Basis::kRoundoff,
        "rounding of a position of 1 m over a drop of 5 cm, with room for what is left of the "
        "motion"},
       "forces of the body and the law out of balance, or the run is too short to come to rest"},
      chain_drop(1.0));
  add_sabotage(check, "spring constant +1 %", relative_error(chain_drop(1.01)));
  report.checks.push_back(std::move(check));
}

struct Steps {
  double beta;
  double measured;  ///< [s]
  double guard;     ///< [s]
};

Steps steps_with(double beta) {
  const auto make = [beta] { return floating_cloth(beta); };
  reference::SpringSolver solver = make_solver(make(), IntegratorKind::kModifiedEuler);
  return {beta, largest_stable_step(make), solver.stability().stable_step};
}

void check_steps(const CaseInfo& info, Report& report) {
  const Steps plain = steps_with(0.0);
  Table table{"Largest stable step of a floating cloth, found by trying",
              {"beta [1]", "step [s]", "over that without", "sqrt(1 + beta)", "step guard [s]"},
              {}};
  const Tolerance tolerance{0.01, Basis::kTruncation,
                            "two brackets of 1e-3 from the bisection, and a disturbance that grows "
                            "too slowly to be seen just beyond the stable step"};
  double ratio_error = 0, guard_error = 0, without_error = 0;
  for (const double beta : {0.0, 0.5, 1.0, 3.0}) {
    const Steps steps = beta > 0 ? steps_with(beta) : plain;
    const double predicted = std::sqrt(1 + beta);
    const double ratio = steps.measured / plain.measured;
    ratio_error = std::max(ratio_error, std::abs(ratio / predicted - 1));
    guard_error = std::max(guard_error, std::abs(steps.guard / steps.measured - 1));
    without_error = std::max(without_error, std::abs(plain.guard / steps.measured - 1));
    table.rows.push_back({fmt::format("{:g}", beta), fmt::format("{:.5g}", steps.measured),
                          fmt::format("{:.4f}", ratio), fmt::format("{:.4f}", predicted),
                          fmt::format("{:.5g}", steps.guard)});
  }
  CheckResult ratio =
      judged(info,
             {"the largest stable step grows by sqrt(1 + beta), beta = 0.5, 1, 3",
              "largest relative error of the ratio to the step without it",
              "h(beta) / h(0) = sqrt(1 + beta)", "h w < 2 of modified Euler, w^2 / (1 + beta)",
              tolerance, "the redistribution of forces"},
             ratio_error);
  const double more = largest_stable_step([] { return floating_cloth(1.1 * 3.0); });
  add_sabotage(ratio, "beta +10 %", std::abs(more / plain.measured / 2 - 1));
  report.checks.push_back(std::move(ratio));
  CheckResult guard = judged(info,
                             {"the step guard knows it", "largest relative error of its step",
                              "largest step found by trying", "bisection over runs", tolerance,
                              "the power iteration with redistributed forces"},
                             guard_error);
  add_sabotage(guard, "the guard of the body without the law", without_error);
  report.checks.push_back(std::move(guard));
  Section section{std::string(info.id), std::string(info.summary), {}, {}, {}, ""};
  section.tables.push_back(std::move(table));
  report.sections.push_back(std::move(section));
}

/// Kinetic energy per mass [m^2/s^2] of a hung cloth after 20 s at a step half way (in ratio)
/// between what is stable without and with beta = 3; not finite if it explodes.
double energy_left(double beta) {
  constexpr double kWithBeta = 3.0;
  constexpr double kEnd = 20.0;  // [s]
  reference::SpringSolver plain = make_solver(floating_cloth(0.0), IntegratorKind::kModifiedEuler);
  const double time_step = plain.stability().stable_step * std::pow(1 + kWithBeta, 0.25);
  reference::Body body = floating_cloth(beta);
  body.mesh.pinned = {0, 7};
  body.laws = {};
  body.laws.add(forces::make_law<double>(tension_law(200.0), body.mesh));
  body.laws.add(forces::make_law<double>(gravity_law({0, -9.81, 0}), body.mesh));
  body.laws.add(forces::make_law<double>(velocity_damping_law(3.0), body.mesh));
  if (beta > 0) body.laws.add(right_law(beta, body.mesh));
  reference::SpringSolver solver = make_solver(std::move(body), IntegratorKind::kModifiedEuler);
  for (int step = 0; step < std::lround(kEnd / time_step); ++step) {
    if (solver.step(time_step).blow_up) return std::numeric_limits<double>::infinity();
  }
  const reference::Body& end = solver.system().bodies[0];
  return 0.5 * end.velocities.colwise().squaredNorm().dot(end.mesh.masses) / end.mesh.masses.sum();
}

void check_rest(const CaseInfo& info, Report& report) {
  CheckResult check =
      judged(info,
             {"a hung cloth comes to rest at a step at which it explodes without it",
              "kinetic energy per mass after 20 s over 1 m^2/s^2",
              "step = (1 + beta)^(1/4) times the stable one without, beta = 3",
              "h w < 2 sqrt(1 + beta)",
              {1e-6, Basis::kModelGap, "what the settling metric calls rest: speeds below 1 mm/s"},
              "the redistribution of forces, or the damping that brings it to rest"},
             energy_left(3.0));
  add_sabotage(check, "without the law", energy_left(0.0));
  report.checks.push_back(std::move(check));
}

}  // namespace
}  // namespace acceleration_damping

void evaluate_acceleration_damping(const CaseInfo& info, const CaseOptions&, const EngineRuns&,
                                   Report& report) {
  using namespace acceleration_damping;
  check_periods(info, report);
  check_amplitude(info, report);
  check_free_fall(info, report);
  check_static_shape(info, report);
  check_steps(info, report);
  check_rest(info, report);
}

}  // namespace weft::validation
