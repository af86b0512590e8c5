// Where the energy of a swinging cloth goes, and the momentum of a free one.
// Tested by tests/apps/CMakeLists.txt.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <weft/custom_forces/registry.hpp>
#include <weft/mesh/cloth_grid.hpp>
#include <weft/reference/balance.hpp>
#include <weft/validation/cases/support/analytic_cases.hpp>
#include <weft/validation/cases/support/closed_form_check.hpp>
#include <weft/validation/cases/support/sabotage.hpp>
#include <weft/validation/cases/support/small_systems.hpp>

namespace weft::validation {
namespace energy_ledger {
namespace {

using reference::IntegratorKind;

constexpr int kNodes = 9;
constexpr double kSide = 0.8;      // [m]
constexpr double kMass = 0.13;     // [kg]
constexpr double kGravity = 9.81;  // [m/s^2]
constexpr double kEndTime = 2.0;   // [s]

struct Setting {
  IntegratorKind integrator = IntegratorKind::kVelocityVerlet;
  double damping = 0.01;      ///< of springs [N s/m]
  double drag = 0.3;          ///< velocity_damping [1/s]
  double time_step = 1e-3;    ///< [s]
  bool flip_damping = false;  ///< sabotage
  double hidden = 0.0;        ///< sabotage: sideways acceleration that no ledger knows of [m/s^2]
};

reference::Body make_cloth(bool is_free, const Setting& setting) {
  ClothGrid grid;
  grid.nodes = {kNodes, kNodes};
  grid.size = {kSide, kSide};
  grid.stencil = GridStencil::k12Neighbour;
  grid.total_mass = kMass;
  reference::Body body;
  body.name = "cloth";
  body.mesh = make_cloth_grid(grid);
  if (!is_free) body.mesh.pinned = {0, kNodes - 1};
  std::vector<forces::LawSpecification> laws = {tension_law(120),
                                                spring_damping_law(setting.damping),
                                                {"hinge_torsion", {}, {{"rigidity", {2e-3}}}},
                                                {"torsion", {}, {{"stiffness", {0.05}}}}};
  if (!is_free) {
    laws.push_back(gravity_law({0, -kGravity, 0}));
    laws.push_back(velocity_damping_law(setting.drag));
  }
  for (const forces::LawSpecification& law : laws) {
    auto made = forces::make_law<double>(law, body.mesh);
    const bool flip = setting.flip_damping && made->info().traits.dissipative;
    body.laws.add(flip ? negated(std::move(made)) : std::move(made));
  }
  body.positions = body.mesh.rest_positions;
  body.velocities.setZero(3, body.mesh.num_nodes());
  if (setting.hidden != 0) {
    body.external_forces = Matrix3X<double>::Zero(3, body.mesh.num_nodes());
    body.external_forces.row(2) = setting.hidden * body.mesh.masses.transpose();
  }
  return body;
}

/// Largest |E(t) - E(0) - work of the dampers| over the energy that the fall sets free, and how much of it
/// the dampers took.
struct Ledger {
  double gap = 0.0;    ///< [-]
  double taken = 0.0;  ///< [-]
};

Ledger keep_ledger(const Setting& setting) {
  reference::SpringSolver solver = make_solver(make_cloth(false, setting), setting.integrator);
  reference::Energies before = reference::energies(solver.system());
  const double start = before.total();
  // The potential energy has no natural zero: what the fall sets free is the largest motion's.
  double scale = 1e-300;
  double work = 0;
  double gap = 0;
  const auto steps = std::lround(kEndTime / setting.time_step);
  for (long step = 0; step < steps; ++step) {
    (void)solver.step(setting.time_step);
    const reference::Energies now = reference::energies(solver.system());
    work += setting.time_step * (before.power + now.power) / 2;
    gap = std::max(gap, std::abs(now.total() - start - work));
    scale = std::max(scale, now.kinetic);
    before = now;
  }
  return {gap / scale, -work / scale};
}

/// Largest change of momentum (angular about the origin) of a free cloth that was stretched, bent and spun.
struct Drift {
  double linear = 0.0;   ///< over sum m |v| [-]
  double angular = 0.0;  ///< over sum m |x||v| [-]
};

Drift drift(double hidden) {
  Setting setting;
  setting.hidden = hidden;
  reference::Body body = make_cloth(true, setting);
  for (int node = 0; node < body.mesh.num_nodes(); ++node) {
    const double u = node % kNodes - (kNodes - 1) / 2.0;
    const double v = node / kNodes - (kNodes - 1) / 2.0;
    body.positions(1, node) += 0.01 * u * v;
    body.positions(0, node) *= 1.1;
    body.velocities.col(node) << 0.3 * v, 1.0 - 0.2 * u, 0.4 - 0.3 * u;
  }
  reference::SpringSolver solver = make_solver(std::move(body), IntegratorKind::kVelocityVerlet);
  const Vector3<double> linear = reference::linear_momentum(solver.system());
  const Vector3<double> angular = reference::angular_momentum(solver.system());
  const reference::Body& now = solver.system().bodies[0];
  const double scale = now.velocities.colwise().norm() * now.mesh.masses;
  Drift result;
  constexpr int kSteps = 1000;
  for (int step = 0; step < kSteps; ++step) {
    (void)solver.step(1e-3);
    result.linear = std::max(result.linear,
                             (reference::linear_momentum(solver.system()) - linear).norm() / scale);
    result.angular =
        std::max(result.angular,
                 (reference::angular_momentum(solver.system()) - angular).norm() / (scale * kSide));
  }
  return result;
}

}  // namespace
}  // namespace energy_ledger

void evaluate_energy_ledger(const CaseInfo& info, const CaseOptions&, const EngineRuns&,
                            Report& report) {
  using namespace energy_ledger;
  const Tolerance half_percent{5e-3, Basis::kTruncation,
                               "second order in the step of 1 ms for velocity Verlet"};
  const auto add = [&](const std::string& claim, const Setting& right, const Setting& wrong,
                       const std::string& mistake) {
    const Ledger ledger = keep_ledger(right);
    CheckResult check = judged(
        info,
        {fmt::format("{} (dampers take {:.0f} % of the largest kinetic energy)", claim,
                     100 * std::max(0.0, ledger.taken)),
         "largest gap in the ledger over the largest kinetic energy, 0 to 2 s",
         "E(t) = E(0) + integral of P", "first law; work of the dampers by the trapezoidal rule",
         half_percent, "an energy, a power or a force that does not belong to it"},
        ledger.gap);
    add_sabotage(check, mistake, keep_ledger(wrong).gap);
    report.checks.push_back(std::move(check));
  };
  add("a swinging cloth with dampers keeps its ledger", {}, {.hidden = 0.1},
      "a sideways force of 1 % of the weight that is not in the ledger");
  add("a swinging cloth without dampers keeps its energy", {.damping = 0, .drag = 0},
      {.damping = 0, .drag = 0, .hidden = 0.1},
      "a sideways force of 1 % of the weight that is not in the ledger");

  // Dampers that drive are in the ledger as well, so order is what tells whether it is more than small.
  const Setting fine{.time_step = 5e-4};
  const double order = std::log2(keep_ledger({}).gap / keep_ledger(fine).gap);
  CheckResult second =
      judged(info,
             {"the gap falls with the square of the step",
              "|observed order - 2|, steps 1 ms and 0.5 ms",
              "p = log2(e(h) / e(h / 2))",
              "velocity Verlet",
              {0.3, Basis::kTruncation, "two levels only, of a largest value over time"},
              "a work that is summed at the wrong time"},
             std::abs(order - 2));
  const Setting euler{.integrator = IntegratorKind::kModifiedEuler};
  const Setting fine_euler{.integrator = IntegratorKind::kModifiedEuler, .time_step = 5e-4};
  add_sabotage(second, "modified Euler instead",
               std::abs(std::log2(keep_ledger(euler).gap / keep_ledger(fine_euler).gap) - 2));
  report.checks.push_back(std::move(second));

  const Drift right = drift(0);
  const Drift wrong = drift(1e-6);
  CheckResult linear =
      judged(info,
             {"a free cloth keeps its momentum",
              "largest change over sum m |v|, 1000 steps",
              "sum m v = const",
              "Newton's third law",
              {1e-13, Basis::kRoundoff, "1000 steps, each with a rounding of 1e-16"},
              "a force that is not given back"},
             right.linear);
  add_sabotage(linear, "a field of 1e-6 m/s^2", wrong.linear);
  report.checks.push_back(std::move(linear));
  CheckResult angular =
      judged(info,
             {"a free cloth keeps its angular momentum",
              "largest change over sum m |v| L, 1000 steps",
              "sum x cross m v = const",
              "internal forces without torque",
              {1e-13, Basis::kRoundoff, "1000 steps, each with a rounding of 1e-16"},
              "a hinge or a spring with a torque of its own"},
             right.angular);
  add_sabotage(angular, "a field of 1e-6 m/s^2", wrong.angular);
  report.checks.push_back(std::move(angular));
}

}  // namespace weft::validation
