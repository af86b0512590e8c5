#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/Eigenvalues>

#include <weft/custom_forces/law_set.hpp>
#include <weft/custom_forces/registry.hpp>
#include <weft/fast_solver/network/network_forces.hpp>
#include <weft/mesh/cloth_grid.hpp>

#include "tests/fast_solver/node_arrays.hpp"

namespace weft::fast {
namespace {

using forces::LawSpecification;

ClothMesh cloth() {
  ClothGrid grid;
  grid.nodes = {6, 5};
  grid.total_mass = 0.3;
  return make_cloth_grid(grid);
}

/// The rest shape, disturbed by a few hundredths of a spring, or by so much that springs are
/// compressed.
Matrix3X<double> positions(const ClothMesh& mesh, double by) {
  std::srand(7);  // Eigen's Random
  return mesh.rest_positions + by * Matrix3X<double>::Random(3, mesh.num_nodes());
}

const LawSpecification kTension{
    "tension", {}, {{"stiffness", {50.0}}, {"compression_ratio", {0.3}}}};
const LawSpecification kStretch{"tension", {"stretch"}, {{"stiffness", {20.0}}}};
const LawSpecification kDamping{"spring_damping", {"shear"}, {{"damping", {0.7}}}};
const LawSpecification kBending{"hinge_torsion", {}, {{"rigidity", {0.01}}}};

TEST(SpringNetwork, HasTheForcesOfTheLaws) {
  const ClothMesh mesh = cloth();
  const double h = 0.01;
  const Matrix3X<double> q = positions(mesh, 0.05);
  const Matrix3X<double> x = positions(mesh, 0.08);
  NetworkForces<double> network(make_network(mesh, {kTension, kStretch}), mesh.num_nodes());
  begin_step(network, q, h);
  const Matrix3X<double> forces = forces_at(network, x);
  forces::LawSet<double> laws;
  for (const auto& law : {kTension, kStretch}) laws.add(forces::make_law<double>(law, mesh));
  Matrix3X<double> expected = Matrix3X<double>::Zero(3, mesh.num_nodes());
  const Matrix3X<double> v = Matrix3X<double>::Zero(3, mesh.num_nodes());
  (void)laws.add_forces({x, v, mesh.masses, 0.0}, forces::LawSet<double>::VelocityLaws::kAsForces,
                        expected);
  EXPECT_LT((forces - expected).norm(), 1e-10 * expected.norm());
}

// At rest all that stiff springs pull with is rounding, which is much more than what friction or gravity may be. It must be equal
// at both ends, wherever the loops over nodes meet them: else it drives the sheet.
TEST(SpringNetwork, SpringsPullAlikeAtBothEnds) {
  const LawSpecification stiff{"tension", {}, {{"stiffness", {1e6}}}};
  for (const int nodes : {3, 7, 15, 40}) {
    for (const bool has_dampers : {false, true}) {
      ClothGrid grid;
      grid.nodes = {nodes, nodes};
      grid.size = {0.5, 0.5};
      const ClothMesh mesh = make_cloth_grid(grid);
      std::vector<LawSpecification> laws{stiff};
      if (has_dampers) laws.push_back(kDamping);
      NetworkForces<float> network(make_network(mesh, laws), mesh.num_nodes());
      for (const double place : {0.0, 0.011, -0.3, 0.7}) {
        Matrix3X<double> x = mesh.rest_positions;
        x.colwise() += place * Vector3<double>(1, -0.2, 0.3);
        const Matrix3X<float> at_rest = x.cast<float>();
        begin_step<float>(network, at_rest, 1.0F / 60);
        const Matrix3X<double> forces = forces_at<float>(network, at_rest).cast<double>();
        EXPECT_LE(forces.rowwise().sum().norm(), 1e-4 * forces.cwiseAbs().sum())
            << nodes << " nodes, " << has_dampers << " " << place;
      }
    }
  }
}

TEST(SpringNetwork, DampsTheChangeOfLength) {
  const ClothMesh mesh = cloth();
  const double h = 1e-6;  // [s] so that (l - l_q) / h is the rate of the length to a part in 1e5
  const Matrix3X<double> v = Matrix3X<double>::Random(3, mesh.num_nodes());
  const Matrix3X<double> x = positions(mesh, 0.05);
  const Matrix3X<double> q = x - h * v;
  NetworkForces<double> network(make_network(mesh, {kDamping}), mesh.num_nodes());
  begin_step(network, q, h);
  const Matrix3X<double> forces = forces_at(network, x);
  forces::LawSet<double> laws;
  laws.add(forces::make_law<double>(kDamping, mesh));
  Matrix3X<double> expected = Matrix3X<double>::Zero(3, mesh.num_nodes());
  (void)laws.add_forces({x, v, mesh.masses, 0.0}, forces::LawSet<double>::VelocityLaws::kAsForces,
                        expected);
  EXPECT_LT((forces - expected).norm(), 1e-4 * expected.norm());
}

TEST(SpringNetwork, ItsProductIsTheDerivativeWhereSpringsAreStretched) {
  const ClothMesh mesh = cloth();
  const Matrix3X<double> x = 1.3 * positions(mesh, 0.01);  // every spring is longer than at rest
  NetworkForces<double> network(make_network(mesh, {kTension, kDamping}), mesh.num_nodes());
  const double h = 0.02;
  begin_step<double>(network, mesh.rest_positions, h);
  const Matrix3X<double> d = Matrix3X<double>::Random(3, mesh.num_nodes());
  const auto forces_after = [&](double by) { return forces_at<double>(network, x + by * d); };
  const double by = 1e-5;
  const Matrix3X<double> expected = (forces_after(-by) - forces_after(by)) / (2 * by);
  (void)forces_after(0);
  const int rows = rows_for(mesh.num_nodes());
  NodeArrays<float> displacements(rows, 3);
  to_arrays<float>(d.cast<float>(), network.all_nodes(), displacements);
  NodeArrays<float> product(rows, 3);
  network.multiply(network.all_nodes(), VectorX<float>::Zero(rows), displacements, product);
  const NodeArrays<double> result = product.cast<double>();
  // Each number of a linearization is stored in half precision, and two are multiplied: 2 x 2^-11.
  EXPECT_LT((result.topRows(mesh.num_nodes()).transpose() - expected).norm(),
            1e-3 * expected.norm());
}

TEST(SpringNetwork, ItsBlocksAreThoseOfTheProduct) {
  const ClothMesh mesh = cloth();
  NetworkForces<float> network(make_network(mesh, {kTension, kBending}), mesh.num_nodes());
  const Matrix3X<float> x = positions(mesh, 0.05).cast<float>();
  begin_step(network, x, 0.01F);
  (void)forces_at(network, x);
  const int rows = rows_for(mesh.num_nodes());
  const BlockArrays& blocks = network.diagonal_blocks();
  const int entry[3][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}};
  for (const int node : {0, 7, 13, 29}) {
    for (int axis = 0; axis < 3; ++axis) {
      NodeArrays<float> d = NodeArrays<float>::Zero(rows, 3);
      d(node, axis) = 1;
      NodeArrays<float> product(rows, 3);
      network.multiply(network.all_nodes(), VectorX<float>::Zero(rows), d, product);
      // Each number of a linearization is stored in half precision for products: 2 x 2^-11.
      const float bound = 1e-3F * blocks.row(node).head<3>().maxCoeff();
      for (int row = 0; row < 3; ++row) {
        EXPECT_NEAR(product(node, row), blocks(node, entry[row][axis]), bound) << node;
      }
    }
  }
}

TEST(SpringNetwork, TheStabiliserBoundsBendingAtRest) {
  const ClothMesh mesh = cloth();
  const int n = mesh.num_nodes();
  const SpringNetwork network = make_network(mesh, {kBending});
  Eigen::MatrixXd bound = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index e = 0; e < network.edges.cols(); ++e) {
    const int i = network.edges(0, e);
    const int j = network.edges(1, e);
    bound(i, i) += network.bending[e];
    bound(j, j) += network.bending[e];
    bound(i, j) -= network.bending[e];
    bound(j, i) -= network.bending[e];
  }
  const auto law = forces::make_law<double>(kBending, mesh);
  forces::LawSet<double> laws;
  laws.add(forces::make_law<double>(kBending, mesh));
  const Matrix3X<double> v = Matrix3X<double>::Zero(3, n);
  Eigen::MatrixXd stiffness(3 * n, 3 * n);
  for (int c = 0; c < 3 * n; ++c) {
    Matrix3X<double> d = Matrix3X<double>::Zero(3, n);
    d(c % 3, c / 3) = 1;
    Matrix3X<double> product = Matrix3X<double>::Zero(3, n);
    laws.add_stiffness_product({mesh.rest_positions, v, mesh.masses, 0.0}, d, product);
    stiffness.col(c) = -product.reshaped();
  }
  Eigen::MatrixXd difference = -stiffness;
  for (int c = 0; c < 3; ++c) {
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) difference(3 * i + c, 3 * j + c) += bound(i, j);
    }
  }
  const double size = bound.norm();
  EXPECT_GT(size, 0.1);  // there is bending at all
  const Eigen::VectorXd values = difference.selfadjointView<Eigen::Lower>().eigenvalues();
  EXPECT_GT(values.minCoeff(), -1e-9 * size);
}

TEST(SpringNetwork, ThreadsAndRunsAgree) {
  const SpringNetwork a = make_network(cloth(), {kTension, kDamping, kBending});
  const SpringNetwork b = make_network(cloth(), {kTension, kDamping, kBending});
  EXPECT_EQ(a.bending, b.bending);
  EXPECT_EQ(a.edges, b.edges);
}

}  // namespace
}  // namespace weft::fast
