#include <cmath>

#include <gtest/gtest.h>

#include <weft/fast_solver/implicit_solver.hpp>
#include <weft/mesh/cloth_grid.hpp>
#include <weft/mesh/cutting/tear.hpp>
#include <weft/mesh/mesh_part.hpp>

#include "tests/fast_solver/node_arrays.hpp"

namespace weft::fast {
namespace {

const std::vector<forces::LawSpecification> kLaws = {
    {"tension", {}, {{"stiffness", {50.0}}, {"compression_ratio", {0.5}}}},
    {"spring_damping", {"stretch"}, {{"damping", {0.1}}}},
    {"hinge_torsion", {}, {{"rigidity", {1e-3}}}}};

ClothMesh cloth(int n) {
  ClothGrid grid;
  grid.nodes = {n, n};
  grid.total_mass = 0.2;
  ClothMesh mesh = make_cloth_grid(grid);
  for (int i = 0; i < n; ++i) mesh.pinned.push_back(i);
  return mesh;
}

/// A cut of three edges along a row of a grid of n x n, or of four along a column.
Edges cut_at(int n, int k) {
  Edges cut(2, k % 2 == 0 ? 3 : 4);
  for (int e = 0; e < static_cast<int>(cut.cols()); ++e) {
    const int first = k % 2 == 0 ? (3 + 2 * k) * n + 4 + k + e : (2 + e) * n + 6 + k;
    cut.col(e) << first, first + (k % 2 == 0 ? 1 : n);
  }
  return cut;
}

std::vector<char> flags_of(const Tear& tear) {
  std::vector<char> flags(static_cast<std::size_t>(tear.mesh.num_nodes()), 0);
  for (const int node : tear.changed) flags[static_cast<std::size_t>(node)] = 1;
  return flags;
}

std::vector<bool> free_flags(const ClothMesh& mesh) {
  std::vector<bool> is_free(static_cast<std::size_t>(mesh.num_nodes()), true);
  for (const int node : mesh.pinned) is_free[static_cast<std::size_t>(node)] = false;
  return is_free;
}

void expect_same_network(const SpringNetwork& a, const SpringNetwork& b) {
  ASSERT_EQ(a.edges.cols(), b.edges.cols());
  EXPECT_EQ(a.edges, b.edges);
  EXPECT_EQ(a.rest_lengths, b.rest_lengths);
  EXPECT_EQ(a.stiffness, b.stiffness);
  EXPECT_EQ(a.compressed_stiffness, b.compressed_stiffness);
  EXPECT_EQ(a.damping, b.damping);
  // Sums over hinges in another order.
  EXPECT_LT((a.bending - b.bending).lpNorm<Eigen::Infinity>(),
            1e-13 * b.bending.lpNorm<Eigen::Infinity>());
}

void expect_same_forces(NetworkForces<double>& a, NetworkForces<double>& b, int num_nodes) {
  std::srand(5);  // Eigen's Random
  const Matrix3X<double> q = Matrix3X<double>::Random(3, num_nodes);
  const Matrix3X<double> x = q + 0.1 * Matrix3X<double>::Random(3, num_nodes);
  begin_step(a, q, 0.01);
  begin_step(b, q, 0.01);
  const Matrix3X<double> of_a = forces_at(a, x);
  const Matrix3X<double> of_b = forces_at(b, x);
  // Sums of some fifty springs in another order.
  EXPECT_LT((of_a - of_b).norm(), 1e-14 * of_b.norm());
  const NodeArrays<double> positions = arrays_of(x);
  EXPECT_NEAR(a.potential(a.all_nodes(), positions), b.potential(b.all_nodes(), positions),
              1e-14 * b.potential(b.all_nodes(), positions));
  const int rows = rows_for(num_nodes);
  NodeArrays<float> d = NodeArrays<float>::Random(rows, 3);
  d.bottomRows(rows - num_nodes).setZero();
  NodeArrays<float> product_a(rows, 3);
  NodeArrays<float> product_b(rows, 3);
  const VectorX<float> inertia = VectorX<float>::Ones(rows);
  a.multiply(a.all_nodes(), inertia, d, product_a);
  b.multiply(b.all_nodes(), inertia, d, product_b);
  EXPECT_LT((product_a - product_b).norm(), 1e-6F * product_b.norm());
}

TEST(TornNetwork, IsTheOneOfTheTornMeshAfterManyTears) {
  ClothMesh mesh = cloth(24);
  SpringNetwork network = make_network(mesh, kLaws);
  NetworkForces<double> forces(network, mesh.num_nodes());
  for (int k = 0; k < 6; ++k) {
    const Tear tear = cut_along(mesh, cut_at(24, k));
    ASSERT_TRUE(tear.any());
    const std::vector<char> is_changed = flags_of(tear);
    EXPECT_LT(tear.changed.size(), 120U);  // what is far away is not looked at
    const SpringNetwork springs = make_network_at(is_changed, tear.mesh, kLaws);
    replace_springs(is_changed, springs, network);
    mesh = tear.mesh;
    const SpringNetwork fresh = make_network(mesh, kLaws);
    expect_same_network(network, fresh);
    forces.replace(springs, is_changed, mesh.num_nodes());
    NetworkForces<double> fresh_forces(fresh, mesh.num_nodes());
    expect_same_forces(forces, fresh_forces, mesh.num_nodes());
  }
}

// Springs that cross the cut between nodes that stay whole.
TEST(TornNetwork, ForgettingNodesThatDidNotSplitShows) {
  const ClothMesh mesh = cloth(24);
  const Tear tear = cut_along(mesh, cut_at(24, 0));
  std::vector<char> is_split(static_cast<std::size_t>(tear.mesh.num_nodes()), 0);
  for (const int origin : tear.origins) is_split[static_cast<std::size_t>(origin)] = 1;
  for (int node = mesh.num_nodes(); node < tear.mesh.num_nodes(); ++node) {
    is_split[static_cast<std::size_t>(node)] = 1;
  }
  SpringNetwork network = make_network(mesh, kLaws);
  replace_springs(is_split, make_network_at(is_split, tear.mesh, kLaws), network);
  EXPECT_GT(network.edges.cols(), make_network(tear.mesh, kLaws).edges.cols());
}

/// A sheet that hangs from one side, falls for a step of 1/60 s, and what its solver leaves over.
struct Step {
  explicit Step(const ClothMesh& mesh) {
    std::srand(3);
    starts = mesh.rest_positions + 1e-3 * Matrix3X<double>::Random(3, mesh.num_nodes());
    targets = starts;
    for (int i = 0; i < mesh.num_nodes(); ++i) targets(1, i) -= 9.81 * h * h;
    for (const int node : mesh.pinned) targets.col(node) = starts.col(node);
  }
  double residual(ImplicitSolver<double>& solver) {
    WorkerTeam alone;
    return residual(solver, alone);
  }
  double residual(ImplicitSolver<double>& solver, WorkerTeam& team) {
    positions = starts;
    solver.solve({targets, starts, h, h}, solver_settings, positions, team);
    return solver.residual();
  }
  double h = 1.0 / 60;
  SolverSettings solver_settings{3, 4, 0.0};
  Matrix3X<double> starts, targets, positions;
};

TEST(TornSolver, ConvergesRightAfterATear) {
  const int n = 40;
  const ClothMesh mesh = cloth(n);
  const SpringNetwork network = make_network(mesh, kLaws);
  ImplicitSolver<double> solver(network, mesh.masses, free_flags(mesh));
  const Tear tear = cut_along(mesh, cut_at(n, 3));
  const std::vector<char> is_changed = flags_of(tear);
  const SpringNetwork springs = make_network_at(is_changed, tear.mesh, kLaws);
  solver.tear(springs, is_changed, tear.mesh.masses, tear.origins);
  SpringNetwork torn = network;
  replace_springs(is_changed, springs, torn);
  ImplicitSolver<double> fresh(torn, tear.mesh.masses, free_flags(tear.mesh));
  Step after(tear.mesh);
  Step expected(tear.mesh);
  const double residual = after.residual(solver);
  const double of_fresh = expected.residual(fresh);
  // The old coarse basis functions couple both sides of the cut together: allowed to leave four times as much, and less than a
  // hundredth of what the step began with.
  EXPECT_LT(residual, 4 * of_fresh);
  EXPECT_LT(residual, 0.01);
}

// The last of these tears makes so many nodes that threads share them, and arrays get a gap behind them.
TEST(TornSolver, TearsUntilThreadsShareItsNodes) {
  const int n = 29;
  ClothMesh mesh = cloth(n);
  ASSERT_LT(padded_size(mesh.num_nodes()), kFewestToShare);
  SpringNetwork network = make_network(mesh, kLaws);
  ImplicitSolver<double> solver(network, mesh.masses, free_flags(mesh));
  for (int k = 0; padded_size(mesh.num_nodes()) < kFewestToShare; ++k) {
    Edges cut(2, n - 6);  // most of a row
    for (int e = 0; e < n - 6; ++e) cut.col(e) << (4 + 4 * k) * n + 3 + e, (4 + 4 * k) * n + 4 + e;
    const Tear tear = cut_along(mesh, cut);
    ASSERT_TRUE(tear.any()) << mesh.num_nodes() << " nodes";
    const std::vector<char> is_changed = flags_of(tear);
    const SpringNetwork springs = make_network_at(is_changed, tear.mesh, kLaws);
    solver.tear(springs, is_changed, tear.mesh.masses, tear.origins);
    replace_springs(is_changed, springs, network);
    mesh = tear.mesh;
  }
  ImplicitSolver<double> fresh(network, mesh.masses, free_flags(mesh));
  Step after(mesh);
  Step expected(mesh);
  after.solver_settings = expected.solver_settings = {
      100, 40, 0.0};  // until iterations gain no more, whatever the coarse basis functions
  EXPECT_LT(after.residual(solver), 1e-4);
  EXPECT_LT(expected.residual(fresh), 1e-4);
  const double fall = 9.81 * after.h * after.h * std::sqrt(mesh.num_nodes());
  EXPECT_LT((after.positions - expected.positions).norm(), 1e-3 * fall);
}

TEST(TornSolver, TearsAgainAndAgain) {
  const int n = 30;
  ClothMesh mesh = cloth(n);
  ImplicitSolver<double> solver(make_network(mesh, kLaws), mesh.masses, free_flags(mesh));
  for (int k = 0; k < 5; ++k) {
    const Tear tear = cut_along(mesh, cut_at(n, k));
    const std::vector<char> is_changed = flags_of(tear);
    const SpringNetwork springs = make_network_at(is_changed, tear.mesh, kLaws);
    solver.tear(springs, is_changed, tear.mesh.masses, tear.origins);
    mesh = tear.mesh;
    EXPECT_LT(Step(mesh).residual(solver), 0.02) << k;
  }
}

// From one where all is pinned; before or after a tear.
TEST(TornSolver, FollowsPinsBetweenTears) {
  const int n = 45;
  const std::vector<std::vector<int>> pins = {{0, n - 1}, {n + 3, 1500, 1501}, {0}, {}, {7, 1200}};
  std::vector<Matrix3X<double>> positions;
  for (const int threads : {1, 4}) {
    ClothMesh mesh = cloth(n);
    const std::vector<bool> nobody(static_cast<std::size_t>(mesh.num_nodes()), false);
    ImplicitSolver<double> solver(make_network(mesh, kLaws), mesh.masses, nobody);
    for (int k = 0; k < std::ssize(pins); ++k) {
      mesh.pinned = pins[static_cast<std::size_t>(k)];
      if (k % 2 == 0) solver.set_free(free_flags(mesh));
      const Tear tear = cut_along(mesh, cut_at(n, k));
      const std::vector<char> is_changed = flags_of(tear);
      solver.tear(make_network_at(is_changed, tear.mesh, kLaws), is_changed, tear.mesh.masses,
                  tear.origins);
      mesh = tear.mesh;
      if (k % 2 == 1) solver.set_free(free_flags(mesh));
      Step step(mesh);
      WorkerTeam team;
      const WorkerTeam::Scope scope(team, threads);
      EXPECT_LT(step.residual(solver, team), 0.02) << k;
      for (const int pin : mesh.pinned) EXPECT_EQ(step.positions.col(pin), step.starts.col(pin));
      positions.push_back(step.positions);
    }
  }
  for (std::size_t k = 0; k < pins.size(); ++k)
    EXPECT_EQ(positions[k], positions[k + pins.size()]) << k;
}

// There are no coarse basis functions, and more parts of the nodes than before.
TEST(TornSolver, TearsWhereAllIsPinned) {
  const int n = 30;
  const ClothMesh mesh = cloth(n);
  const std::vector<bool> nobody(static_cast<std::size_t>(mesh.num_nodes()), false);
  ImplicitSolver<double> solver(make_network(mesh, kLaws), mesh.masses, nobody);
  const Tear tear = cut_along(mesh, cut_at(n, 3));
  const std::vector<char> is_changed = flags_of(tear);
  solver.tear(make_network_at(is_changed, tear.mesh, kLaws), is_changed, tear.mesh.masses,
              tear.origins);
  Step step(tear.mesh);
  step.targets = step.starts;
  (void)step.residual(solver);
  EXPECT_EQ(step.positions, step.starts);
}

TEST(TornSolver, GivesTheSameBitsForAnyNumberOfThreads) {
  const int n = 60;
  const ClothMesh mesh = cloth(n);
  const SpringNetwork network = make_network(mesh, {kLaws[0]});
  const Tear tear = cut_along(mesh, cut_at(n, 2));
  const std::vector<char> is_changed = flags_of(tear);
  const SpringNetwork springs = make_network_at(is_changed, tear.mesh, {kLaws[0]});
  std::vector<Matrix3X<double>> positions;
  for (const int threads : {1, 4}) {
    ImplicitSolver<double> solver(network, mesh.masses, free_flags(mesh));
    solver.tear(springs, is_changed, tear.mesh.masses, tear.origins);
    Step step(tear.mesh);
    for (int k = 0; k < 3; ++k) {
      WorkerTeam team;
      const WorkerTeam::Scope scope(team, threads);
      (void)step.residual(solver, team);
    }
    positions.push_back(step.positions);
  }
  EXPECT_EQ(positions[0], positions[1]);
}

TEST(MeshPart, HasEveryElementOfAWantedNode) {
  const ClothMesh mesh = cloth(12);
  std::vector<char> is_wanted(static_cast<std::size_t>(mesh.num_nodes()), 0);
  is_wanted[65] = 1;
  const MeshPart part = part_around(mesh, is_wanted);
  EXPECT_TRUE(std::is_sorted(part.nodes.begin(), part.nodes.end()));
  for (std::size_t s = 0; s < mesh.edge_sets.size(); ++s) {
    int expected = 0;
    for (const auto edge : mesh.edge_sets[s].edges.colwise()) {
      expected += edge[0] == 65 || edge[1] == 65 ? 1 : 0;
    }
    EXPECT_EQ(part.mesh.edge_sets[s].name, mesh.edge_sets[s].name);
    EXPECT_EQ(part.mesh.edge_sets[s].edges.cols(), expected);
  }
  EXPECT_EQ(part.mesh.rest_positions, mesh.rest_positions(Eigen::all, part.nodes));
  EXPECT_LT(part.mesh.triangles.cols(), 60);
  EXPECT_GT(part.mesh.crossed_triangles.cols(), 0);
}

}  // namespace
}  // namespace weft::fast
