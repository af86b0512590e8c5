// A decision on contact states gives friction other bounds, which changes the energy without any motion.
#include <gtest/gtest.h>

#include <weft/fast_solver/implicit_solver.hpp>
#include <weft/mesh/cloth_grid.hpp>

namespace weft::fast {
namespace {

constexpr float kStepOfBoxes = 1.0F / 60;  // [s]
constexpr float kFreeFall = 9.81F;         // [m/s^2]

/// How many of these steps were not solved: a stiff sheet that slides over a floor and is bumpy, so that its nodes press on the
/// floor more or less from step to step.
int num_unsolved(int num_steps) {
  ClothGrid grid;
  grid.nodes = {4, 4};
  grid.size = {2, 2};  // [m]
  grid.v_axis = {0, 0, 1};
  grid.total_mass = 20;  // [kg]
  const ClothMesh mesh = make_cloth_grid(grid);
  const Eigen::Index n = mesh.num_nodes();
  const SpringNetwork network = make_network(mesh, {{"tension", {}, {{"stiffness", {1e5}}}}});
  ImplicitSolver<float> solver(network, mesh.masses,
                               std::vector<bool>(static_cast<std::size_t>(n), true));
  Matrix3X<float> q = mesh.rest_positions.cast<float>();
  q.row(1).setZero();
  Matrix3X<float> v = Matrix3X<float>::Zero(3, n);
  v.row(0).setConstant(5);
  for (Eigen::Index i = 0; i < n; ++i) v(1, i) = static_cast<float>(i % 3) - 1;
  std::vector<PlaneContact<float>> contacts(static_cast<std::size_t>(n));
  for (int i = 0; i < n; ++i) {
    PlaneContact<float>& contact = contacts[static_cast<std::size_t>(i)];
    contact.node = i;
    contact.normal = {0, 1, 0};
    contact.friction = 0.2F;
  }
  int count = 0;
  for (int step = 0; step < num_steps; ++step) {
    Matrix3X<float> y = q + kStepOfBoxes * v;
    Matrix3X<float> x = y;
    y.row(1).array() -= kFreeFall * kStepOfBoxes * kStepOfBoxes;
    solver.solve({y, q, kStepOfBoxes, kStepOfBoxes, contacts}, {}, x);
    v = (x - q) / kStepOfBoxes;
    q = x;
    count += solver.report().is_converged ? 0 : 1;
  }
  return count;
}

TEST(FrictionBounds, OfADecisionAreNoGainOfEnergy) {
  constexpr int kSteps = 100;
  EXPECT_LE(num_unsolved(kSteps), kSteps / 20);
}

}  // namespace
}  // namespace weft::fast
