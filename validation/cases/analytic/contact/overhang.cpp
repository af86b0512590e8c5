// A chain that hangs over the edge of a table: how much of it may, before all of it goes.
// Tested by tests/validation/cases/support/parameters_test.cpp.
#include <array>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include <weft/custom_forces/registry.hpp>
#include <weft/validation/cases/support/analytic_cases.hpp>
#include <weft/validation/cases/support/closed_form_check.hpp>
#include <weft/validation/cases/support/parameters.hpp>
#include <weft/validation/cases/support/small_systems.hpp>

namespace weft::validation {
namespace overhang {
namespace {

constexpr double kRadius = 0.1;   // of the edge [m]
constexpr double kWeight = 1.0;   // of a node on table and edge [N]
constexpr double kMass = 1.0;     // of a node [kg]
constexpr double kStrain = 1e-4;  // of the springs under what hangs [-]
constexpr int kHanging = 3;       // nodes, whose weight is what is looked for

struct Table {
  double friction = 0.3;
  double length = 8.0;           ///< of the chain on the table, in radii of the edge
  int edge_nodes = 8;            ///< on the quarter turn of the edge
  double friction_factor = 1.0;  ///< sabotage

  [[nodiscard]] double turn() const { return 0.5 * std::numbers::pi / edge_nodes; }
  [[nodiscard]] double spacing() const { return 2 * kRadius * std::sin(turn() / 2); }
  [[nodiscard]] int table_nodes() const {
    return static_cast<int>(std::lround(length * kRadius / spacing()));
  }
  /// Largest weight that hangs still [N]: along the chain, each node at its limit.
  [[nodiscard]] double exact_weight() const {
    const double s = std::sin(turn() / 2);
    const double c = std::cos(turn() / 2);
    double tension = friction * table_nodes() * kWeight;
    for (int i = 0; i < edge_nodes; ++i) {
      const double angle = (i + 0.5) * turn();
      tension = (tension * (c + friction * s) +
                 kWeight * (friction * std::cos(angle) - std::sin(angle))) /
                (c - friction * s);
    }
    return tension;
  }
  /// Share of the chain's weight that is beyond the edge.
  [[nodiscard]] double overhang(double hanging_weight) const {
    return hanging_weight / (hanging_weight + (table_nodes() + edge_nodes) * kWeight);
  }
};

Matrix3X<double> places_of(const Table& table) {
  const double turn = table.turn();
  const double spacing = table.spacing();
  const int first_hanging = table.table_nodes() + table.edge_nodes;
  Matrix3X<double> places = Matrix3X<double>::Zero(3, first_hanging + kHanging);
  for (int i = 0; i < table.edge_nodes; ++i) {
    const double angle = (i + 0.5) * turn;
    places.col(table.table_nodes() + i) << kRadius * std::sin(angle), kRadius * std::cos(angle), 0;
  }
  // The neighbors of those on the edge are farther away, or they would touch it too.
  for (int i = table.table_nodes() - 1; i >= 0; --i) {
    const double share = i == table.table_nodes() - 1 ? 1.5 : 1.0;
    places.col(i) = places.col(i + 1) - Vector3<double>(share * spacing, 0, 0);
  }
  for (int i = first_hanging; i < places.cols(); ++i) {
    const double share = i == first_hanging ? 1.5 : 1.0;
    places.col(i) = places.col(i - 1) - Vector3<double>(0, share * spacing, 0);
  }
  return places;
}

// The edge is a great circle of a sphere, so that a polygon's straight end lies a little below its top:
// there the table's top is.
void add_table(const Table& table, const Matrix3X<double>& places, reference::System& system) {
  const double length = 2 * -places(0, 0);
  reference::Collider top;
  top.name = "table";
  top.shape = reference::Box{{length / 2, kRadius / 4, kRadius}};
  top.position = {-length / 2, kRadius * std::cos(table.turn() / 2) - kRadius / 4, 0};
  reference::Collider edge;
  edge.name = "edge";
  edge.shape = reference::Sphere{kRadius};
  system.colliders = {top, edge};
}

/// Whether the chain goes over the edge with this weight hanging [N]: it keeps moving when all else has
/// come to rest.
bool slips(const Table& table, double hanging_weight) {
  SpringBody springs;
  springs.positions = places_of(table);
  const auto n = static_cast<int>(springs.positions.cols());
  springs.edges.resize(2, n - 1);
  for (int i = 1; i < n; ++i) springs.edges.col(i - 1) << i - 1, i;
  springs.masses = VectorX<double>::Constant(n, kMass);
  const double stiffness = table.exact_weight() / (kStrain * table.spacing());
  const double rate = std::sqrt(stiffness / kMass);  // of a node on its spring [rad/s]
  const double damping = 3 * rate / n;  // the slowest wave along the chain dies fastest
  springs.laws = {tension_law(stiffness), velocity_damping_law(damping)};
  reference::Body body = make_body(springs);
  body.friction = table.friction * table.friction_factor;
  body.external_forces = Matrix3X<double>::Zero(3, n);
  reference::System system;
  system.bodies.push_back(std::move(body));
  add_table(table, springs.positions, system);
  reference::SpringSolver solver(std::move(system), {});
  const double step = 0.5 / rate;
  const int num_steps = static_cast<int>(std::lround(40 / (damping * step)));
  Matrix3X<double> weights = Matrix3X<double>::Zero(3, n);
  weights.row(1).setConstant(-kWeight);
  for (int i = 0; i < num_steps; ++i) {
    const double part =
        std::min(1.0, 2.0 * i / num_steps);  // slowly, so that no wave helps it over
    weights.row(1).tail(kHanging).setConstant(-part * hanging_weight / kHanging);
    solver.set_external_forces(0, weights);
    if (solver.step(step).blow_up) return true;
  }
  // A difference of 1e-4 of the weight would move the whole chain at this speed.
  const double moving = 1e-4 * table.exact_weight() / (n * kMass * damping);
  return -solver.system().bodies[0].velocities(1, n - 1) > moving;
}

double largest_overhang(const Table& table) {
  double low = 0.0;
  double high = 2 * table.exact_weight();
  constexpr int kBisections = 12;
  for (int i = 0; i < kBisections; ++i) {
    const double middle = 0.5 * (low + high);
    (slips(table, middle) ? high : low) = middle;
  }
  return table.overhang(0.5 * (low + high));
}

void add_check(const CaseInfo& info, const Table& table, Report& report) {
  const double exact = table.overhang(table.exact_weight());
  const auto overhang = [&](const Table& each) {
    return ComparedValue{"overhang over the weight", largest_overhang(each), exact, "1"};
  };
  const double grip = table.friction * std::exp(table.friction * std::numbers::pi / 2);
  CheckResult check = judged(
      info,
      {fmt::format("a chain over a table's edge, mu = {}, {} nodes on the edge", table.friction,
                   table.edge_nodes),
       fmt::format(
           "relative error of the overhang (a rope's over a sharp edge: {:.4f} of the weight)",
           grip / (1 + grip)),
       "T (c - mu s) = T' (c + mu s) + w (mu cos a - sin a), s, c of half a turn; T' = mu w n on "
       "the "
       "table",
       "balance of each node at its limit; mu e^(mu pi / 2) (L - h) = h for a rope",
       {0.01, Basis::kModelGap, "nodes move on by a strain of 1e-4 before they hold"},
       "Coulomb friction of the impulse contact on a flat and on a round body"},
      overhang(table));
  Table wrong = table;
  wrong.friction_factor = 1.1;
  add_sabotage(check, "friction +10 %", relative_error(overhang(wrong)));
  wrong.friction_factor = 0.0;
  add_sabotage(check, "no friction", relative_error(overhang(wrong)));
  report.checks.push_back(std::move(check));
}

constexpr std::array kParameters = {
    CaseParameter{"mu", "1", "friction of chain and table", 0.2, 0.6, 0.3},
    CaseParameter{"nodes", "1", "on the quarter turn of the edge", 4, 16, 8, true},
    CaseParameter{"length", "1", "of the chain on the table, in radii of the edge", 6, 20, 8},
};

}  // namespace
}  // namespace overhang

std::span<const CaseParameter> overhang_parameters() {
  using namespace overhang;
  return kParameters;
}

void evaluate_overhang(const CaseInfo& info, const CaseOptions& options, const EngineRuns&,
                       Report& report) {
  using namespace overhang;
  if (asks_for_point(options)) {
    add_check(info,
              {.friction = value_of(info, options, "mu"),
               .length = value_of(info, options, "length"),
               .edge_nodes = static_cast<int>(value_of(info, options, "nodes"))},
              report);
    return;
  }
  for (const double friction : {0.2, 0.3, 0.5}) add_check(info, {.friction = friction}, report);
  add_check(info, {.edge_nodes = 4}, report);
}

}  // namespace weft::validation
