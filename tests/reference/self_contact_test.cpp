// Cloth with itself and with other cloth: no layer ever passes through another one, as an
// independent count of edges through triangles sees it.
#include <cmath>

#include <gtest/gtest.h>

#include <weft/validation/metrics/self_intersection.hpp>
#include <weft/validation/reference/balance.hpp>
#include <weft/validation/reference/contact/continuous_distance.hpp>

#include "tests/reference/small_systems.hpp"

namespace weft::reference::testing {
namespace {

using Vec = Vector3<double>;

int piercings(const Body& body) {
  return static_cast<int>(validation::self_piercings(body.positions, body.mesh.triangles).size());
}

TEST(ContinuousDistance, FindsAFastPassageThatNoEndShows) {
  FourPoints start, motion;
  start << 0.2, 0, 1, 0, 1.0, 0, 0, 0, 0.2, 0, 0, 1;
  motion.setZero();
  motion(1, 0) = -2000.0;  // through the triangle, to 1999 m behind it
  const auto hit = first_approach(PairKind::kPointTriangle, start, motion, 1e-4);
  ASSERT_TRUE(hit);
  EXPECT_NEAR(*hit, 1.0 / 2000.0, 1e-7);
  motion(0, 0) = 4000.0;  // past its side
  EXPECT_FALSE(first_approach(PairKind::kPointTriangle, start, motion, 1e-4));
}

TEST(NearestEdges, AreNearestAtCrossingsEndsAndParallels) {
  FourPoints crossing;
  crossing << -1, 1, 0, 0, 0, 0, 0.3, 0.3, 0, 0, -1, 1;
  EXPECT_NEAR(nearest_edges(crossing).distance(), 0.3, 1e-15);
  FourPoints ends;
  ends << 0, 1, 2, 3, 0, 0, 1, 2, 0, 0, 0, 0;
  EXPECT_NEAR(nearest_edges(ends).distance(), std::sqrt(2.0), 1e-15);
  FourPoints parallel;
  parallel << 0, 1, 0.5, 3, 0, 0, 0.2, 0.2, 0, 0, 0, 0;
  EXPECT_NEAR(nearest_edges(parallel).distance(), 0.2, 1e-15);
}

Body layer(const std::string& name, double height, double speed) {
  Body body = make_cloth(5, 0.5, 0.1, height, 100.0, 0.05);
  body.name = name;
  body.velocities.row(1).setConstant(speed);
  body.mutual_contact = true;
  body.self_thickness = 0.01;
  body.friction = 0.5;
  return body;
}

TEST(MutualContact, ABulletFastLayerDoesNotPassThroughAnother) {
  for (const IntegratorKind integrator :
       {IntegratorKind::kModifiedEuler, IntegratorKind::kVelocityVerlet}) {
    System system;
    system.bodies.push_back(layer("below", 0.0, 0.0));
    system.bodies.push_back(layer("above", 0.1, -300.0));  // 0.3 m in a step
    for (int i = 0; i < 25; ++i) system.bodies[1].positions.col(i) += Vec(0.03, 0, 0.02);
    SpringSolver solver(std::move(system), {.integrator = integrator});
    const Vec momentum = linear_momentum(solver.system());
    for (int n = 0; n < 20; ++n) {
      const StepOutcome outcome = solver.step(1e-3);
      EXPECT_EQ(outcome.contact.num_stopped_nodes, 0) << name_of(integrator) << n;
      const Body& a = solver.system().bodies[0];
      const Body& b = solver.system().bodies[1];
      ASSERT_EQ(
          validation::count_piercings(a.positions, a.mesh.triangles, b.positions, b.mesh.triangles),
          0)
          << name_of(integrator) << ", step " << n;
    }
    EXPECT_LT((linear_momentum(solver.system()) - momentum).norm(), 1e-11 * momentum.norm());
  }
}

/// A strip that falls on its lower edge and folds up on the ground.
System folding_strip(int n, bool self_contact) {
  Body body;
  body.name = "strip";
  ClothGrid grid;
  grid.nodes = {n, 3 * n};
  grid.size = {0.2, 0.6};
  grid.center = {0, 0.42, 0};
  grid.u_axis = {1, 0, 0};
  grid.v_axis = {0, 1, 0.05};
  grid.total_mass = 0.03;
  grid.stencil = GridStencil::k12Neighbour;
  body.mesh = make_cloth_grid(grid);
  body.positions = body.mesh.rest_positions;
  body.velocities.setZero(3, body.mesh.num_nodes());
  add_law(body, "tension", {{"stiffness", {20.0}}});
  add_law(body, "spring_damping", {{"damping", {2e-3}}});
  add_law(body, "gravity", {{"acceleration", {0, -9.81, 0}}});
  add_law(body, "velocity_damping", {{"rate", {1.0}}});
  body.collision_margin = 4e-3;
  body.friction = 0.4;
  body.self_contact = self_contact;
  body.self_thickness = 6e-3;
  System system = system_of(std::move(body));
  system.colliders.push_back({.name = "ground", .shape = Plane{}});
  return system;
}

int crossings_of_fold(System system, double duration, int* stopped) {
  SpringSolver solver(std::move(system));
  const double h = 0.5 * solver.stability().stable_step;
  int count = 0;
  while (solver.time() < duration) {
    const StepOutcome outcome = solver.step(h);
    if (stopped != nullptr) *stopped += outcome.contact.num_stopped_nodes;
    if (outcome.blow_up) return -1;
    count += piercings(solver.system().bodies[0]);
  }
  return count;
}

TEST(SelfContact, AFoldingDropNeverCrossesItself) {
  int stopped = 0;
  EXPECT_EQ(crossings_of_fold(folding_strip(5, true), 0.6, &stopped), 0);
  EXPECT_EQ(stopped, 0);
}

TEST(SelfContact, WithoutItTheSameDropCrossesItself) {
  EXPECT_GT(crossings_of_fold(folding_strip(5, false), 0.6, nullptr), 0);
}

/// A cloth between two rows of pinned nodes that turn against each other about the x axis.
int crossings_of_twist(int n, double turns, bool self_contact, int* stopped) {
  Body body = make_cloth(n, 0.5, 0.05, 0.0, 40.0, 5e-3);
  add_law(body, "velocity_damping", {{"rate", {2.0}}});
  for (int side : {0, n - 1}) {
    for (int j = 0; j < n; ++j) body.mesh.pinned.push_back(j * n + side);
  }
  std::sort(body.mesh.pinned.begin(), body.mesh.pinned.end());
  body.self_contact = self_contact;
  body.self_thickness = 6e-3;
  body.friction = 0.3;
  const Matrix3X<double> rest = body.mesh.rest_positions;
  const std::vector<int> pinned = body.mesh.pinned;
  // Out of the plane: of exactly coplanar edges and triangles the count would see rounding.
  for (int i = 0; i < body.mesh.num_nodes(); ++i) {
    body.positions(1, i) += 1e-4 * std::sin(40 * rest(0, i)) * std::cos(30 * rest(2, i) + 1);
  }
  SpringSolver solver(system_of(std::move(body)));
  const double h = 0.5 * solver.stability().stable_step;
  const double rate = 2 * M_PI;  // [rad/s] of each side
  int count = 0;
  while (solver.time() * rate < M_PI * turns) {
    const double angle = rate * (solver.time() + h);
    Matrix3X<double> targets(3, static_cast<Eigen::Index>(pinned.size()));
    for (std::size_t i = 0; i < pinned.size(); ++i) {
      const Vec from = rest.col(pinned[i]);
      const double sign = from.x() < 0 ? -1.0 : 1.0;
      Vec to = Eigen::AngleAxisd(sign * angle, Vec::UnitX()) * from;
      to.x() *= 0.8;  // slack, so that it can wind up
      if (solver.time() < 0.1) to.x() = from.x() * (1 - 0.2 * (solver.time() + h) / (0.1 + h));
      targets.col(static_cast<Eigen::Index>(i)) = to;
    }
    solver.lead_pins(0, targets, h);
    const StepOutcome outcome = solver.step(h);
    solver.place_pins(0, targets);
    if (stopped != nullptr) *stopped += outcome.contact.num_stopped_nodes;
    if (outcome.blow_up) return -1;
    count += piercings(solver.system().bodies[0]);
  }
  return count;
}

TEST(SelfContact, ATwistedClothNeverCrossesItself) {
  int stopped = 0;
  EXPECT_EQ(crossings_of_twist(9, 1.5, true, &stopped), 0);
  EXPECT_EQ(stopped, 0);
}

TEST(SelfContact, WithoutItTheSameTwistCrossesItself) {
  EXPECT_GT(crossings_of_twist(9, 1.5, false, nullptr), 0);
}

}  // namespace
}  // namespace weft::reference::testing
