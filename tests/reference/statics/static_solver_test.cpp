#include <weft/reference/statics/static_solver.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <weft/core/error.hpp>
#include <weft/custom_forces/registry.hpp>
#include <weft/custom_forces/spectrum.hpp>
#include <weft/mesh/cloth_grid.hpp>
#include <weft/mesh/icosphere.hpp>
#include <weft/reference/statics/coupling.hpp>

namespace weft::reference {
namespace {

Body hung_cloth() {
  ClothGrid grid;
  grid.nodes = {7, 6};
  Body body;
  body.name = "cloth";
  body.mesh = make_cloth_grid(grid);
  body.mesh.pinned = {0, 6};
  for (const forces::LawSpecification& law :
       std::vector<forces::LawSpecification>{{"tension", {}, {{"stiffness", {50.0}}}},
                                             {"hinge_torsion", {}, {{"rigidity", {0.05}}}},
                                             {"gravity", {}, {{"acceleration", {0, -9.81, 0}}}}}) {
    body.laws.add(forces::make_law<double>(law, body.mesh));
  }
  body.positions = body.mesh.rest_positions;
  body.velocities.setZero(3, body.mesh.num_nodes());
  return body;
}

TEST(StaticSolver, FindsWhereNoFreeNodeFeelsAForce) {
  Body body = hung_cloth();
  const double weight = 9.81 * body.mesh.masses.sum();
  const StaticProblem problem = static_problem(body, weight);
  Matrix3X<double> positions = body.mesh.rest_positions;
  const StaticOutcome outcome = solve_statics(problem, positions);
  EXPECT_TRUE(outcome.converged);
  Matrix3X<double> forces = Matrix3X<double>::Zero(3, positions.cols());
  problem.forces(positions, forces);
  for (const int node : body.mesh.pinned) {
    EXPECT_EQ(positions.col(node), body.mesh.rest_positions.col(node)) << "pins stay bit for bit";
    forces.col(node).setZero();
  }
  EXPECT_LE(forces.colwise().norm().maxCoeff(), 1e-10 * weight);
  EXPECT_LT(positions.row(1).minCoeff(), -0.5) << "it hangs, and does not stand";
}

TEST(StaticSolver, SaysWhenItDoesNotArrive) {
  Body body = hung_cloth();
  const StaticProblem problem = static_problem(body, 1.0);
  Matrix3X<double> positions = body.mesh.rest_positions;
  StaticOptions options;
  options.max_iterations = 2;
  const StaticOutcome outcome = solve_statics(problem, positions, options);
  EXPECT_FALSE(outcome.converged);
  EXPECT_EQ(outcome.iterations, 2);
}

TEST(StaticSolver, ColorsKeepTheColumnsOfAProductApart) {
  const Body body = hung_cloth();
  const Edges coupled = coupled_nodes(body);
  const int n = body.mesh.num_nodes();
  const std::vector<int> colors = column_colors(coupled, n);
  std::vector<std::vector<int>> rows(static_cast<std::size_t>(n));
  for (int node = 0; node < n; ++node) rows[static_cast<std::size_t>(node)].push_back(node);
  for (Eigen::Index e = 0; e < coupled.cols(); ++e) {
    rows[static_cast<std::size_t>(coupled(0, e))].push_back(coupled(1, e));
    rows[static_cast<std::size_t>(coupled(1, e))].push_back(coupled(0, e));
  }
  for (const std::vector<int>& row : rows) {
    std::vector<int> seen;
    for (const int node : row) seen.push_back(colors[static_cast<std::size_t>(node)]);
    std::sort(seen.begin(), seen.end());
    EXPECT_EQ(std::adjacent_find(seen.begin(), seen.end()), seen.end());
  }
}

TEST(StaticSolver, AGasIsRefusedForItCouplesEverything) {
  Body body;
  body.mesh = make_icosphere({.frequency = 1});
  body.laws.add(forces::make_law<double>({"pressure", {}, {{"pressure", {100.0}}}}, body.mesh));
  EXPECT_THROW((void)coupled_nodes(body), InvalidArgument);
}

TEST(CriticalTimeStep, OfOneSpringIsTwoOverItsFrequency) {
  ClothMesh mesh;
  mesh.rest_positions = Matrix3X<double>::Zero(3, 2);
  mesh.rest_positions(0, 1) = 1.0;
  mesh.triangles.resize(3, 0);
  mesh.edge_sets.push_back({"spring", Edges(2, 1)});
  mesh.edge_sets.front().edges << 0, 1;
  mesh.masses = VectorX<double>::Constant(2, 0.5);  // reduced mass 0.25 kg
  const forces::LawSpecification spring{"tension", {}, {{"stiffness", {100.0}}}};
  const double omega = std::sqrt(100.0 / 0.25);
  EXPECT_NEAR(forces::critical_time_step(mesh, {spring}), 2 / omega, 1e-6 / omega);
  const forces::LawSpecification inertia{"acceleration_damping", {}, {{"beta", {3.0}}}};
  EXPECT_NEAR(forces::critical_time_step(mesh, {spring, inertia}), 4 / omega, 1e-6 / omega);
}

TEST(CriticalTimeStep, CountsTorsion) {
  const Body body = hung_cloth();
  const forces::LawSpecification tension{"tension", {}, {{"stiffness", {1.0}}}};
  const forces::LawSpecification hinges{"hinge_torsion", {}, {{"rigidity", {5.0}}}};
  EXPECT_LT(forces::critical_time_step(body.mesh, {tension, hinges}),
            0.5 * forces::critical_time_step(body.mesh, {tension}));
}

}  // namespace
}  // namespace weft::reference
