// What must not matter: who watches, which way is north, in what units, in which order, left or right.
// Tested by tests/apps/CMakeLists.txt.
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <vector>

#include <fmt/format.h>

#include <weft/custom_forces/registry.hpp>
#include <weft/mesh/cloth_grid.hpp>
#include <weft/reference/solver.hpp>
#include <weft/validation/cases/support/analytic_cases.hpp>
#include <weft/validation/cases/support/closed_form_check.hpp>

namespace weft::validation {
namespace invariances {
namespace {

/// A cloth held at two corners falls on a sphere. Everything that the transformations act on.
struct Setting {
  Matrix3<double> turn = Matrix3<double>::Identity();  ///< a mirror too
  Vector3<double> velocity{0, 0, 0};                   ///< [m/s] of everything
  bool ball_stays = false;  ///< sabotage: the sphere does not take part in the velocity
  double meter = 1.0;       ///< new units per m, kg, s [-]
  double kilogram = 1.0;
  double second = 1.0;
  double stiffness_slip = 1.0;    ///< sabotage: factor of the stiffness [-]
  std::vector<int> order = {};    ///< new number of each node; empty: as they are
  bool crossed_left_out = false;  ///< sabotage
};

constexpr int kNodes = 9;         // along a side
constexpr double kSide = 0.8;     // [m]
constexpr double kStep = 1e-3;    // [s]
constexpr int kSteps = 400;       // the cloth meets the sphere after 0.15 s
constexpr double kRadius = 0.25;  // [m]

void renumber(ClothMesh& mesh, const std::vector<int>& order) {
  const ClothMesh old = mesh;
  for (int node = 0; node < mesh.num_nodes(); ++node) {
    const int now = order[static_cast<std::size_t>(node)];
    mesh.rest_positions.col(now) = old.rest_positions.col(node);
    mesh.masses[now] = old.masses[node];
  }
  const auto number = [&](int& node) { node = order[static_cast<std::size_t>(node)]; };
  for (Triangles* triangles : {&mesh.triangles, &mesh.crossed_triangles}) {
    std::for_each(triangles->data(), triangles->data() + triangles->size(), number);
  }
  for (EdgeSet& set : mesh.edge_sets) {
    std::for_each(set.edges.data(), set.edges.data() + set.edges.size(), number);
    for (Eigen::Index e = 0; e < set.edges.cols(); ++e) {
      if (set.edges(0, e) > set.edges(1, e)) std::swap(set.edges(0, e), set.edges(1, e));
    }
  }
  for (LineSet& set : mesh.line_sets) {
    std::for_each(set.triples.data(), set.triples.data() + set.triples.size(), number);
  }
  std::for_each(mesh.pinned.begin(), mesh.pinned.end(), number);
  std::sort(mesh.pinned.begin(), mesh.pinned.end());
}

ClothMesh make_mesh(const Setting& setting) {
  ClothGrid grid;
  grid.nodes = {kNodes, kNodes};
  grid.size = {kSide, kSide};
  grid.stencil = GridStencil::k12Neighbour;
  grid.total_mass = 0.13;
  ClothMesh mesh = make_cloth_grid(grid);
  mesh.pinned = {0, kNodes - 1};
  if (setting.crossed_left_out) mesh.crossed_triangles.resize(3, 0);
  if (!setting.order.empty()) renumber(mesh, setting.order);
  mesh.rest_positions = setting.meter * setting.turn * mesh.rest_positions;
  mesh.masses *= setting.kilogram;
  const Vector3<double> speed = setting.turn * setting.velocity * (setting.meter / setting.second);
  mesh.pinned_velocities = speed.replicate(1, 2);
  return mesh;
}

reference::System make_system(const Setting& s) {
  reference::System system;
  system.gravity = s.turn * Vector3<double>(0, -9.81, 0) * (s.meter / (s.second * s.second));
  reference::Body body;
  body.name = "cloth";
  body.mesh = make_mesh(s);
  const double per_length = s.kilogram / (s.second * s.second);  // N/m
  const Vector3<double>& g = system.gravity;
  for (const forces::LawSpecification& law : std::vector<forces::LawSpecification>{
           {"gravity", {}, {{"acceleration", {g.x(), g.y(), g.z()}}}},
           {"tension", {}, {{"stiffness", {120 * per_length * s.stiffness_slip}}}},
           {"spring_damping", {}, {{"damping", {0.02 * s.kilogram / s.second}}}},
           {"hinge_torsion", {}, {{"rigidity", {2e-3 * per_length * s.meter * s.meter}}}},
           {"torsion", {}, {{"stiffness", {0.05 * per_length}}}}}) {
    body.laws.add(forces::make_law<double>(law, body.mesh));
  }
  const Vector3<double> speed = s.turn * s.velocity * (s.meter / s.second);
  body.positions = body.mesh.rest_positions;
  body.velocities = speed.replicate(1, body.mesh.num_nodes());
  body.collision_margin = 0.01 * s.meter;
  body.friction = 0.4;
  system.bodies.push_back(std::move(body));
  reference::Collider ball;
  ball.name = "ball";
  ball.shape = reference::Sphere{kRadius * s.meter};
  ball.position = s.meter * s.turn * Vector3<double>(0.03, -0.37, 0.07);
  if (!s.ball_stays) ball.velocity = speed;
  system.colliders.push_back(ball);
  return system;
}

/// Places at the end as the untransformed setting has them, 3 x n [m].
Matrix3X<double> end_places(const Setting& s) {
  reference::SpringSolver solver(make_system(s), {});
  for (int step = 0; step < kSteps; ++step) (void)solver.step(kStep * s.second);
  const Matrix3X<double> moved = s.turn.transpose() * solver.system().bodies[0].positions / s.meter;
  Matrix3X<double> places = moved.colwise() - s.velocity * (kSteps * kStep);
  if (s.order.empty()) return places;
  Matrix3X<double> in_order(3, places.cols());
  for (Eigen::Index node = 0; node < places.cols(); ++node) {
    in_order.col(node) = places.col(s.order[static_cast<std::size_t>(node)]);
  }
  return in_order;
}

/// Largest way between the two, over the cloth's side [-].
double difference(const Setting& setting, const Matrix3X<double>& original) {
  return (end_places(setting) - original).colwise().norm().maxCoeff() / kSide;
}

std::vector<Matrix3<double>> turns() {
  std::vector<Matrix3<double>> list;
  std::array<int, 3> axes = {0, 1, 2};
  do {
    for (int signs = 0; signs < 8; ++signs) {
      Matrix3<double> turn = Matrix3<double>::Zero();
      for (int k = 0; k < 3; ++k) {
        turn(k, axes[static_cast<std::size_t>(k)]) = (signs >> k) % 2 == 0 ? 1 : -1;
      }
      if (turn.determinant() > 0) list.push_back(turn);
    }
  } while (std::next_permutation(axes.begin(), axes.end()));
  const Vector3<double> axis = Vector3<double>(0.3, -0.8, 0.52).normalized();
  list.push_back(Eigen::AngleAxisd(1.234, axis).toRotationMatrix());
  return list;
}

Setting turned(const Matrix3<double>& turn) {
  Setting setting;
  setting.turn = turn;
  return setting;
}

}  // namespace
}  // namespace invariances

void evaluate_invariances(const CaseInfo& info, const CaseOptions&, const EngineRuns&,
                          Report& report) {
  using namespace invariances;
  const Matrix3X<double> original = end_places({});
  const Tolerance tolerance{1e-12, Basis::kRoundoff,
                            "400 steps with contact, each with a rounding of 1e-16 that grows as "
                            "the cloth's motion does"};
  const auto add = [&](const std::string& claim, const std::string& formula, double measured,
                       const std::string& mistake, double sabotaged) {
    CheckResult check =
        judged(info,
               {claim, "largest way between the two cloths after 0.4 s over their side", formula,
                "invariance of mechanics", tolerance,
                "a law, a contact or a damper that knows the world's axes, origin or units"},
               measured);
    add_sabotage(check, mistake, sabotaged);
    report.checks.push_back(std::move(check));
  };
  const Vector3<double> speed(1.3, -0.7, 2.1);  // [m/s]
  add("a cloth that flies by falls as one at rest", "x'(t) = x(t) + V t",
      difference({.velocity = speed}, original), "the sphere stays behind by 1 m/s",
      difference({.velocity = {0, 0, 1}, .ball_stays = true}, original));

  double largest = 0;
  for (const Matrix3<double>& turn : turns()) {
    largest = std::max(largest, difference(turned(turn), original));
  }
  Setting slipped = turned(turns().back());
  slipped.stiffness_slip = 1 + 1e-6;
  add("a cloth falls alike in 24 directions of the axes and an odd one", "x' = R x", largest,
      "spring constant +1e-6", difference(slipped, original));

  // Feet, pounds and minutes: no power of two, so that every rounding is another one.
  Setting units{.meter = 1 / 0.3048, .kilogram = 1 / 0.45359237, .second = 1.0 / 60};
  const double right = difference(units, original);
  units.stiffness_slip = 1 / 0.3048;
  add("a cloth falls alike in feet, pounds and minutes", "x' = x m/ft", right,
      "a stiffness in N/ft", difference(units, original));

  std::vector<int> order(kNodes * kNodes);
  std::iota(order.begin(), order.end(), 0);
  for (std::size_t i = order.size() - 1; i > 0; --i)
    std::swap(order[i], order[(i * 7919 + 13) % (i + 1)]);
  Setting mixed;
  mixed.order = order;
  const double in_any_order = difference(mixed, original);
  mixed.crossed_left_out = true;
  add("the order of the nodes does not matter", "x'_p(i) = x_i", in_any_order,
      "the cells' other diagonals are lost", difference(mixed, original));

  Matrix3<double> mirror = Matrix3<double>::Identity();
  mirror(0, 0) = -1;
  slipped = turned(mirror);
  slipped.stiffness_slip = 1 + 1e-6;
  add("a cloth in a mirror falls as the mirror shows it", "x' = diag(-1, 1, 1) x",
      difference(turned(mirror), original), "spring constant +1e-6", difference(slipped, original));
}

}  // namespace weft::validation
