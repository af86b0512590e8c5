#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <numeric>
#include <optional>
#include <vector>

#include <weft/fast_solver/coarse/coarse_correction.hpp>
#include <weft/fast_solver/coarse/smoothed_aggregation.hpp>
#include <weft/fast_solver/network/network_forces.hpp>
#include <weft/mesh/cloth_grid.hpp>

#include "tests/fast_solver/node_arrays.hpp"

namespace weft::fast {
namespace {

constexpr int kSide = 14;

/// A sheet of which one side is pinned, crumpled a little, and its correction.
struct Sheet {
  explicit Sheet(float inertia_of_node) {
    ClothGrid grid;
    grid.nodes = {kSide, kSide};
    mesh = make_cloth_grid(grid);
    const SpringNetwork network = make_network(mesh, {{"tension", {}, {{"stiffness", {50.0}}}}});
    forces.emplace(network, mesh.num_nodes());
    for (int i = 0; i < mesh.num_nodes(); ++i) {
      names.push_back(i);
      is_free.push_back(true);
    }
    springs = forces->connectivity_graph(names);
    correction = CoarseCorrection(springs, forces->slots());
    pin(side());
    std::srand(4);
    const Matrix3X<double> x =
        mesh.rest_positions + 0.02 * Matrix3X<double>::Random(3, mesh.num_nodes());
    begin_step(*forces, mesh.rest_positions, 1.0 / 60);
    (void)forces_at(*forces, x);
    const int rows = rows_for(mesh.num_nodes());
    inertia.setConstant(rows, inertia_of_node);
    inertia.tail(rows - mesh.num_nodes()).setZero();
    is_held.assign(static_cast<std::size_t>(rows), 0);
  }
  [[nodiscard]] static std::vector<int> side() {
    std::vector<int> result(kSide);
    std::iota(result.begin(), result.end(), 0);
    return result;
  }
  void pin(const std::vector<int>& pins) {
    std::vector<int> changed;
    for (const int i : names) {
      const bool is_pin = std::find(pins.begin(), pins.end(), i) != pins.end();
      if (is_free[at(i)] == is_pin) changed.push_back(i);
      is_free[at(i)] = !is_pin;
    }
    const Neighborhood neighborhood = forces->neighborhood_of(changed, 2 * kBasisReach);
    std::vector<bool> are_free;
    for (const int i : neighborhood.nodes) are_free.push_back(is_free[at(i)]);
    correction.set_free(forces->connectivity_graph(neighborhood.nodes), neighborhood, are_free,
                        forces->slots());
    const std::vector<int> near = forces->neighborhood_of(pins, 2 * kBasisReach).nodes;
    correction.couple(forces->connectivity_graph(near), near, forces->slots());
  }
  void factorize() {
    correction.set_masses(inertia);
    forces->factorize(correction, is_held, sliding, 1, team);
  }
  [[nodiscard]] NodeArrays<float> corrected(const NodeArrays<float>& residual) {
    NodeArrays<float> zeros(residual.rows(), 3);
    NodeArrays<float> result(residual.rows(), 3);
    const NodePartition parts(mesh.num_nodes());
    for (int part = 0; part < parts.count(); ++part) {
      correction.restrict_residual(part, fixed, residual);
    }
    correction.solve(team);
    for (int part = 0; part < parts.count(); ++part) correction.prolongate(part, fixed, result);
    project(result);
    return result;
  }
  [[nodiscard]] NodeArrays<float> stiffness_times(const NodeArrays<float>& displacements) {
    NodeArrays<float> product(displacements.rows(), 3);
    forces->multiply(forces->all_nodes(), inertia, displacements, product);
    project(product);
    return product;
  }
  [[nodiscard]] NodeArrays<float> any_residual() const {
    NodeArrays<float> residual = NodeArrays<float>::Random(inertia.rows(), 3);
    project(residual);
    residual.bottomRows(inertia.rows() - mesh.num_nodes()).setZero();
    return residual;
  }

  void project(NodeArrays<float>& vectors) const {
    for (const int i : names) {
      if (!is_free[at(i)]) vectors.row(i).setZero();
    }
    for (const int i : fixed) vectors.row(i).setZero();
    for (const SlidingNode& one : sliding)
      vectors.row(one.node) -= vectors.row(one.node).dot(one.normal) * one.normal.transpose();
  }
  [[nodiscard]] static std::size_t at(int i) { return static_cast<std::size_t>(i); }

  ClothMesh mesh;
  std::optional<NetworkForces<double>> forces;
  std::vector<int> names;
  std::vector<bool> is_free;
  ConnectivityGraph springs;
  CoarseCorrection correction;
  VectorX<float> inertia;
  std::vector<char> is_held;
  std::vector<int> fixed;
  std::vector<SlidingNode> sliding;
  WorkerTeam team;
};

TEST(SmoothedAggregates, AreFewHatsThatShareEveryNode) {
  const Sheet sheet(1);
  const Aggregates aggregates = find_aggregates(sheet.springs, 30);
  const Prolongation basis_functions =
      smoothed_aggregation(sheet.springs, sheet.is_free, aggregates);
  EXPECT_LE(basis_functions.num_coarse, 30);
  EXPECT_GT(basis_functions.num_coarse, 8);
  std::vector<double> of_basis(static_cast<std::size_t>(basis_functions.num_coarse), 0.0);
  for (int i = 0; i < basis_functions.size(); ++i) {
    const auto row = static_cast<std::size_t>(i);
    ASSERT_LE(basis_functions.starts[row + 1] - basis_functions.starts[row], kMostWeights);
    double sum = 0;
    for (auto e = static_cast<std::size_t>(basis_functions.starts[row]);
         e < static_cast<std::size_t>(basis_functions.starts[row + 1]); ++e) {
      EXPECT_GT(basis_functions.values[e], 0);
      sum += basis_functions.values[e];
      of_basis[static_cast<std::size_t>(basis_functions.columns[e])] += basis_functions.values[e];
    }
    // The pinned side pulls down what is near it, and nothing else does.
    const bool is_far = i / kSide > 11;
    EXPECT_LE(sum, 1 + 1e-12);
    if (is_far) {
      EXPECT_NEAR(sum, 1, 1e-12) << i;
    }
    if (i / kSide <= 1) {
      EXPECT_LT(sum, i / kSide == 0 ? 1e-12 : 0.9) << i;
    }
  }
  // An aggregate in the corner of three others may lose each of its nodes to them.
  EXPECT_GT(std::count_if(of_basis.begin(), of_basis.end(), [](double sum) { return sum > 0; }),
            9 * basis_functions.num_coarse / 10);
}

TEST(SmoothedAggregates, HavePiecesAndLooseNodesToo) {
  ConnectivityGraph network;  // forty pairs, and forty nodes alone
  for (int i = 0; i < 120; ++i) {
    network.matrix.starts.push_back(std::min(i, 80));
    network.matrix.diagonal.push_back(i < 80 ? 1 : 0);
    if (i >= 80) continue;
    network.matrix.columns.push_back(i ^ 1);
    network.matrix.values.push_back(-1);
    network.lengths.push_back(0.1);
  }
  network.matrix.starts.push_back(80);
  const std::vector<bool> is_free(120, true);
  const Prolongation basis_functions =
      smoothed_aggregation(network, is_free, find_aggregates(network, 30));
  EXPECT_EQ(basis_functions.num_coarse, 40);  // none of loose nodes
  EXPECT_EQ(basis_functions.starts.back(), 80);
}

// A displacement that coarse basis functions can have is its own correction, whatever directions the springs have: what is left to differ
// are terms that are left out, and masses that are lumped.
TEST(CoarseCorrection, FindsADisplacementFromItsForces) {
  Sheet sheet(0.01F);
  for (const bool is_held : {false, true}) {
    if (is_held) {
      sheet.fixed = {40, 75, 76, 90, 150};
      for (const int i : sheet.fixed) {
        sheet.is_held[static_cast<std::size_t>(i)] = 1;
      }
    }
    sheet.factorize();
    const NodeArrays<float> displacements = sheet.corrected(sheet.any_residual());
    for (const int i : sheet.fixed) EXPECT_TRUE(displacements.row(i).isZero(0));
    const NodeArrays<float> found = sheet.corrected(sheet.stiffness_times(displacements));
    EXPECT_LT((found - displacements).norm(), 0.1F * displacements.norm()) << is_held;
    EXPECT_GT(displacements.norm(), 0);
  }
}

// A free sheet of which all nodes slide on one plane has only its inertia and friction against it: springs stiffer by 1e4 do not
// hold it, and it does not leave the plane.
TEST(CoarseCorrection, ASheetOnAPlaneSlidesAsAWhole) {
  constexpr float kDrag = 0.03F;
  Sheet sheet(0.01F);
  sheet.pin({});
  const Vector3<float> normal = Vector3<float>(1, 2, -2) / 3;
  for (const int i : sheet.names) sheet.sliding.push_back({i, normal, 1000, kDrag});
  sheet.factorize();
  const Vector3<float> along = Vector3<float>(2, -1, 0).normalized();
  NodeArrays<float> residual = NodeArrays<float>::Zero(sheet.inertia.rows(), 3);
  for (const int i : sheet.names) residual.row(i) = (0.01F + kDrag) * along.transpose();
  const NodeArrays<float> found = sheet.corrected(residual);
  for (const int i : sheet.names)
    EXPECT_LT((found.row(i) - along.transpose()).norm(), 0.01F) << found.row(i);
}

// Around a ball nothing can slide as a whole: what is found costs springs no more than it gains, up to a factor.
TEST(CoarseCorrection, OvershootsNowhereOnACurvedSurface) {
  Sheet sheet(0.01F);
  sheet.pin({});
  for (const int i : sheet.names) {
    const Vector3<float> normal =
        (sheet.mesh.rest_positions.col(i).cast<float>() - Vector3<float>(0.5F, -0.3F, 0.5F))
            .normalized();
    sheet.sliding.push_back({i, normal, 1000, 0});
  }
  sheet.factorize();
  for (int k = 0; k < 20; ++k) {
    const NodeArrays<float> residual = sheet.any_residual();
    const NodeArrays<float> found = sheet.corrected(residual);
    const float work = found.cwiseProduct(residual).sum();
    const float energy = found.cwiseProduct(sheet.stiffness_times(found)).sum();
    EXPECT_GT(work, 0);
    EXPECT_LT(energy, 4 * work);
  }
}

// A node that is pinned later does not move, and one that is let go does. The matrix is that of the new coarse basis functions.
TEST(CoarseCorrection, FollowsPins) {
  const std::vector<int> side = Sheet::side();
  Sheet sheet(0.01F);
  const std::vector<std::vector<int>> pins = {{0, 13, 100}, {0, 13},     {195}, {},
                                              side,         sheet.names, {7},   side};
  for (const std::vector<int>& pinned : pins) {
    sheet.pin(pinned);
    sheet.factorize();
    const NodeArrays<float> displacements = sheet.corrected(sheet.any_residual());
    for (const int i : sheet.names) {
      EXPECT_EQ(displacements.row(i).isZero(0), !sheet.is_free[static_cast<std::size_t>(i)]) << i;
    }
    const NodeArrays<float> found = sheet.corrected(sheet.stiffness_times(displacements));
    EXPECT_LE((found - displacements).norm(), 0.1F * displacements.norm()) << pinned.size();
  }
}

TEST(CoarseCorrection, ASheetWithoutSpringsMovesAsItsMassesDo) {
  Sheet sheet(1e6F);
  sheet.factorize();
  NodeArrays<float> residual(sheet.inertia.rows(), 3);
  residual.col(1).setConstant(1e6F);
  sheet.project(residual);
  const NodeArrays<float> found = sheet.corrected(residual);
  const int last = sheet.mesh.num_nodes() - 1;
  EXPECT_NEAR(found(last, 1), 1, 1e-3);
  EXPECT_NEAR(found(last, 0), 0, 1e-6);
}

TEST(CoarseCorrection, CorrectsNothingWhereAllIsPinned) {
  CoarseCorrection correction(ConnectivityGraph{{{0, 0, 0, 0}, {}, {}, {1, 1, 1}}, {}}, {});
  NodeArrays<float> values = NodeArrays<float>::Ones(rows_for(3), 3);
  WorkerTeam team;
  correction.restrict_residual(0, {}, values);
  correction.solve(team);
  correction.prolongate(0, {}, values);
  EXPECT_TRUE(values.topRows(3).isZero(0));
}

}  // namespace
}  // namespace weft::fast
