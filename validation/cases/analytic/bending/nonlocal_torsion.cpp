// Ties to far nodes: a flap folded over to its mirror image finds its way back, and a sheet whose
// centre is tied to all other nodes holds it up.
// Tested by tests/apps/CMakeLists.txt.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <weft/custom_forces/registry.hpp>
#include <weft/mesh/cloth_grid.hpp>
#include <weft/validation/cases/support/analytic_cases.hpp>
#include <weft/validation/cases/support/closed_form_check.hpp>
#include <weft/validation/cases/support/small_systems.hpp>

namespace weft::validation {
namespace nonlocal_torsion {
namespace {

constexpr double kSpacing = 0.1;    // [m]
constexpr double kTimeStep = 1e-3;  // [s]
constexpr int kFlapColumn = 4;      // where the flap begins

enum class Ties { kNone, kNonlocal, kUnsignedTorsion };

/// A strip of 9 x 5 nodes: the first five columns lie flat and are pinned, the rest is a flap that
/// stands up at this angle [rad].
Matrix3X<double> flap_shape(const ClothGrid& grid, double angle) {
  Matrix3X<double> positions = make_cloth_grid(grid).rest_positions;
  const double hinge = positions(0, kFlapColumn);
  for (Eigen::Index node = 0; node < positions.cols(); ++node) {
    const double reach = positions(0, node) - hinge;
    if (reach <= 0) continue;
    positions(0, node) = hinge + reach * std::cos(angle);
    positions(1, node) = reach * std::sin(angle);
  }
  return positions;
}

/// RMS distance of the flap's nodes from the rest shape over its length, after the mirror image was
/// let go.
double flap_distance(Ties ties) {
  constexpr double kAngle = std::numbers::pi / 3;
  constexpr double kEndTime = 12.0;  // [s]: the slowest motion has decayed by exp(-12)
  ClothGrid grid;
  grid.nodes = {9, 5};
  grid.size = {8 * kSpacing, 4 * kSpacing};
  grid.stencil = GridStencil::k8Neighbour;
  grid.total_mass = 0.1;
  reference::Body body;
  body.name = "flap";
  body.mesh = make_cloth_grid(grid);
  body.mesh.rest_positions = flap_shape(grid, kAngle);
  std::vector<int> flap;
  for (int node = 0; node < body.mesh.num_nodes(); ++node) {
    (node % 9 <= kFlapColumn ? body.mesh.pinned : flap).push_back(node);
  }
  std::vector<forces::LawSpecification> laws = {tension_law(50.0), velocity_damping_law(2.0)};
  if (ties == Ties::kNonlocal) {
    connect(body.mesh, "ties", grid_node(grid, 2, 2), flap);
    laws.push_back({"nonlocal_torsion", {}, {{"stiffness", {0.02}}}});
  } else if (ties == Ties::kUnsignedTorsion) {
    body.mesh.triangles.resize(3, 0);  // no front and no back
    laws.push_back({"torsion", {"lines_u"}, {{"stiffness", {1.0}}}});
  }
  for (const forces::LawSpecification& law : laws) {
    body.laws.add(forces::make_law<double>(law, body.mesh));
  }
  body.positions = flap_shape(grid, -kAngle);
  body.velocities.setZero(3, body.mesh.num_nodes());
  const Matrix3X<double> rest = body.mesh.rest_positions;
  reference::SpringSolver solver =
      make_solver(std::move(body), reference::IntegratorKind::kModifiedEuler);
  for (int step = 0; step * kTimeStep < kEndTime; ++step) (void)solver.step(kTimeStep);
  const Matrix3X<double>& end = solver.system().bodies[0].positions;
  return std::sqrt((end - rest).squaredNorm() / static_cast<double>(flap.size())) / (4 * kSpacing);
}

/// How far the centre of a square sheet, pinned at its corners, hangs below them at rest [m].
double centre_sag(double stiffness) {
  constexpr double kEndTime = 10.0;  // [s]
  ClothGrid grid;
  grid.nodes = {11, 11};
  grid.size = {10 * kSpacing, 10 * kSpacing};
  grid.stencil = GridStencil::k8Neighbour;
  grid.total_mass = 0.2;
  reference::Body body;
  body.name = "sheet";
  body.mesh = make_cloth_grid(grid);
  const int centre = grid_node(grid, 5, 5);
  for (const int i : {0, -1}) {
    for (const int j : {0, -1}) body.mesh.pinned.push_back(grid_node(grid, i, j));
  }
  std::sort(body.mesh.pinned.begin(), body.mesh.pinned.end());
  std::vector<int> others;
  for (int node = 0; node < body.mesh.num_nodes(); ++node) {
    if (node != centre) others.push_back(node);
  }
  connect(body.mesh, "ties", centre, others);
  for (const forces::LawSpecification& law : std::vector<forces::LawSpecification>{
           tension_law(8.0),
           velocity_damping_law(3.0),
           gravity_law({0, -9.81, 0}),
           {"nonlocal_torsion", {}, {{"stiffness", {stiffness}}}}}) {
    body.laws.add(forces::make_law<double>(law, body.mesh));
  }
  body.positions = body.mesh.rest_positions;
  body.velocities.setZero(3, body.mesh.num_nodes());
  reference::SpringSolver solver =
      make_solver(std::move(body), reference::IntegratorKind::kModifiedEuler);
  for (int step = 0; step * kTimeStep < kEndTime; ++step) (void)solver.step(kTimeStep);
  return -solver.system().bodies[0].positions(1, centre);
}

CheckResult base_check(const CaseInfo& info) {
  CheckResult check;
  check.case_id = info.id;
  check.engine = "reference";
  check.unit = "1";
  check.source = "Werth 2008: non-local connections keep faces from folding over";
  check.note = "nonlocal_torsion, or the run is too short to come to rest";
  return check;
}

}  // namespace
}  // namespace nonlocal_torsion

void evaluate_nonlocal_torsion(const CaseInfo& info, const CaseOptions&, const EngineRuns&,
                               Report& report) {
  using namespace nonlocal_torsion;
  CheckResult flap = base_check(info);
  flap.claim = "a flap flipped over to its mirror image comes back";
  flap.metric = "RMS distance from the rest shape over the flap's length, after 12 s";
  flap.formula = "0: the rest shape is the one minimum";
  flap.measured = flap_distance(Ties::kNonlocal);
  flap.tolerance = Tolerance{1e-3, Basis::kTruncation, "what is left of the motion after 12 s"};
  flap.verdict = judge(flap.measured, *flap.tolerance);
  add_sabotage(flap, "no ties", flap_distance(Ties::kNone));
  add_sabotage(flap, "an angle without sign", flap_distance(Ties::kUnsignedTorsion));
  report.checks.push_back(std::move(flap));

  const double sag_without = centre_sag(0.0);
  CheckResult held = base_check(info);
  held.claim = "a sheet whose centre is tied to all other nodes holds it up";
  held.metric = "sag of the centre with ties over the sag without";
  held.measured = centre_sag(3.0) / sag_without;
  held.tolerance = Tolerance{0.25, Basis::kModelGap, "an order of magnitude is claimed, no value"};
  held.verdict = judge(held.measured, *held.tolerance);
  add_sabotage(held, "ties a hundred times weaker", centre_sag(0.03) / sag_without);
  report.checks.push_back(std::move(held));
}

}  // namespace weft::validation
