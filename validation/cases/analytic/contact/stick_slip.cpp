// A strip is pressed on a plane with its tip: friction holds the tip until the strip's own statics ask for more.
// Tested by tests/apps/CMakeLists.txt.
#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include <weft/custom_forces/registry.hpp>
#include <weft/reference/statics/static_solver.hpp>
#include <weft/validation/cases/analytic/bending/pinned_elastica.hpp>
#include <weft/validation/cases/support/analytic_cases.hpp>
#include <weft/validation/cases/support/closed_form_check.hpp>
#include <weft/validation/cases/support/parameters.hpp>
#include <weft/validation/cases/support/small_systems.hpp>

namespace weft::validation {
namespace stick_slip {
namespace {

constexpr double kLength = 1.0;    // L [m]
constexpr double kRigidity = 1.0;  // B [N m^2]
constexpr double kDensity = 1.0;   // [kg/m]
constexpr double kTension = 1e5;   // EA [N]: shorter by 2e-4 under the force of buckling
constexpr double kDamping = 10.0;  // [1/s]: the slowest mode turns by 15 rad/s
constexpr double kBegin = 0.8;     // compression at the start, over the one at which the tip slips
constexpr double kEnd = 1.25;      // and at the end
constexpr double kDuration = 4.0;  // [s]: ten periods of the slowest mode
constexpr double kSettled = 0.85;  // compression at which what the start has stirred up is gone
constexpr double kWatched = 0.95;  // and up to which creep is watched
constexpr double kSlipped = 1e-4;  // [m] way of the tip since then that counts as slipped

struct Press {
  double friction = 0.2;
  int segments = 30;
  double friction_factor = 1.0;  ///< sabotage
  bool plain_clamp = false;      ///< sabotage
  [[nodiscard]] double spacing() const { return kLength / segments; }
};

/// Clamped at the upper end, nodes 0 and 1; the last node is the tip, at the origin.
reference::Body make_rod(const Press& press, double compression) {
  reference::Body body;
  body.name = "rod";
  const int n = press.segments + 2;
  const double a = press.spacing();
  ClothMesh& mesh = body.mesh;
  mesh.rest_positions = Matrix3X<double>::Zero(3, n);
  mesh.triangles.resize(3, 0);
  mesh.masses = VectorX<double>::Constant(n, kDensity * a);
  Edges edges(2, n - 1);
  Triples clamp(3, 1);
  Triples beam(3, n - 3);
  for (int i = 0; i < n; ++i) {
    mesh.rest_positions(1, i) = kLength * (1 - compression) - (i - 1) * a;
    if (i > 0) edges.col(i - 1) << i - 1, i;
    if (i == 2) clamp.col(0) << 0, 1, 2;
    if (i > 2) beam.col(i - 3) << i - 2, i - 1, i;
  }
  mesh.edge_sets.push_back({"row", edges});
  mesh.line_sets.push_back({"clamp", clamp});
  mesh.line_sets.push_back({"beam", beam});
  mesh.pinned = {0, 1};
  const double stiffness = kRigidity / std::pow(a, 3);
  // Half a segment's curvature lies before the clamp: its hinge counts twice.
  for (const forces::LawSpecification& law : std::vector<forces::LawSpecification>{
           tension_law(kTension / a),
           {"torsion", {"clamp"}, {{"stiffness", {(press.plain_clamp ? 1 : 2) * stiffness}}}},
           {"torsion", {"beam"}, {{"stiffness", {stiffness}}}},
           velocity_damping_law(kDamping)}) {
    body.laws.add(forces::make_law<double>(law, mesh));
  }
  body.velocities.setZero(3, n);
  body.positions = mesh.rest_positions;
  return body;
}

/// Bent at rest with its tip held at the origin; false if no equilibrium was found.
bool bend(reference::Body& body, double compression) {
  const auto tip = static_cast<int>(body.positions.cols()) - 1;
  for (int i = 2; i <= tip; ++i) {
    const double s = static_cast<double>(i - 1) / (tip - 1);
    body.positions(0, i) = 0.9 * std::sqrt(compression) * s * std::sin(3.14159 * s) * kLength;
    body.positions(1, i) = kLength * (1 - compression) * (1 - s);
  }
  const std::vector<int> pinned = body.mesh.pinned;
  body.mesh.pinned.push_back(tip);
  const reference::StaticProblem problem =
      reference::static_problem(body, 20 * kRigidity / (kLength * kLength));
  reference::StaticOptions options;
  options.residual = 1e-8;
  options.max_move = 0.05 * kLength;
  options.max_iterations = 1000;
  const bool found = reference::solve_statics(problem, body.positions, options).converged;
  body.mesh.pinned = pinned;
  return found;
}

struct Slip {
  double compression = 0.0;  ///< delta / L at which the tip has slipped, or NaN
  double creep = 0.0;  ///< [m/s] largest speed of the tip from 0.85 to 0.95 of theory's compression
};

Slip press_down(const Press& press, double critical) {
  const double begin = kBegin * critical;
  const double speed = (kEnd - kBegin) * critical * kLength / kDuration;  // [m/s]
  reference::Body body = make_rod(press, begin);
  if (!bend(body, begin)) return {std::nan(""), std::nan("")};
  body.mesh.pinned_velocities = Vector3<double>(0, -speed, 0).replicate(1, 2);
  // Moving as it will, so that no wave runs along it.
  body.velocities.row(1) = -speed * body.positions.row(1) / kLength;
  body.friction = press.friction * press.friction_factor;
  reference::System system;
  const auto tip = body.positions.cols() - 1;
  system.bodies.push_back(std::move(body));
  reference::Collider plane;
  plane.name = "plane";
  plane.shape = reference::Plane{};
  system.colliders.push_back(plane);
  reference::SpringSolver solver(std::move(system), {});
  // Half of the stable step of the springs.
  const double step = 0.5 * press.spacing() / std::sqrt(kTension / kDensity);
  Slip slip;
  double time = 0;
  double before = 0;
  double settled = 0;
  while (time < kDuration) {
    if (solver.step(step).blow_up) break;
    time += step;
    const double compression = begin + speed * time / kLength;
    const double place = solver.system().bodies[0].positions(0, tip);
    if (compression < kSettled * critical) {
      settled = place;
    } else if (compression < kWatched * critical) {
      slip.creep = std::max(slip.creep, std::abs(place - before) / step);
    }
    before = place;
    if (compression >= kSettled * critical && std::abs(place - settled) > kSlipped) {
      slip.compression = compression;
      return slip;
    }
  }
  slip.compression = std::nan("");
  return slip;
}

void add_checks(const CaseInfo& info, const Press& press, Report& report) {
  const PinnedElastica exact = pinned_elastica_of_ratio(press.friction);
  const Slip slip = press_down(press, exact.compression);
  Press wrong = press;
  wrong.friction_factor = 1.1;
  const auto compression = [&](const Slip& each) {
    return ComparedValue{"compression delta / L", each.compression, exact.compression, "1"};
  };
  CheckResult check = judged(
      info,
      {fmt::format("a pressed strip's tip slips where the elastica says, mu = {}", press.friction),
       fmt::format("relative error of the compression delta / L, N = {}", press.segments),
       "sideways force / force = mu, theta'' + F sin(theta - beta) = 0, theta(0) = 0, theta'(1) = "
       "0",
       "clamped and pinned elastica, solved on the spot; Sano, Yamaguchi and Wada 2017",
       {0.03, Basis::kTruncation,
        "second order in the segments, 2e-4 of compression, and the speed of the press"},
       "Coulomb friction of the impulse contact, or the torsion law"},
      compression(slip));
  add_sabotage(check, "friction +10 %",
               relative_error(compression(press_down(wrong, exact.compression))));
  report.checks.push_back(std::move(check));
  CheckResult creep =
      judged(info,
             {fmt::format("a tip that sticks does not creep, mu = {}", press.friction),
              "largest speed of the tip from 0.85 to 0.95 of that compression",
              "0",
              "exact Coulomb friction",
              {1e-9, Basis::kRoundoff, "rounding of a place over a step"},
              "a friction that is smoothed"},
             slip.creep);
  creep.unit = "m/s";
  wrong.friction_factor = 0.8;
  add_sabotage(creep, "friction -20 %", press_down(wrong, exact.compression).creep);
  report.checks.push_back(std::move(creep));
}

constexpr std::array kParameters = {
    CaseParameter{"mu", "1", "friction of strip and plane", 0.05, 0.35, 0.2},
    CaseParameter{"nodes", "1", "segments of the strip", 16, 60, 30, true},
};

}  // namespace
}  // namespace stick_slip

std::span<const CaseParameter> stick_slip_parameters() {
  using namespace stick_slip;
  return kParameters;
}

void evaluate_stick_slip(const CaseInfo& info, const CaseOptions& options, const EngineRuns&,
                         Report& report) {
  using namespace stick_slip;
  if (asks_for_point(options)) {
    add_checks(info,
               {.friction = value_of(info, options, "mu"),
                .segments = static_cast<int>(value_of(info, options, "nodes"))},
               report);
    return;
  }
  for (const double friction : {0.1, 0.2, 0.3}) add_checks(info, {.friction = friction}, report);
}

}  // namespace weft::validation
