#include <weft/fast_solver/prepared_solvers.hpp>

#include <functional>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include <weft/mesh/cloth_grid.hpp>

namespace weft::fast {
namespace {

constexpr double kStepOfCopies = 1.0 / 60;  // [s]

ClothMesh sheet_of_copies(const Vector3<double>& center = {0, 0, 0}) {
  ClothGrid grid;
  grid.nodes = {12, 12};
  grid.center = center;
  grid.total_mass = 0.2;
  return make_cloth_grid(grid);
}

SpringNetwork tension_of(const ClothMesh& mesh, double stiffness) {
  return make_network(mesh, {{"tension", {}, {{"stiffness", {stiffness}}}}});
}

/// One step of a sheet that is pulled.
Matrix3X<float> pulled(ImplicitSolver<float>& solver, const ClothMesh& mesh) {
  const Matrix3X<float> start = mesh.rest_positions.cast<float>();
  Matrix3X<float> target = start;
  for (Eigen::Index i = 0; i < target.cols(); ++i) target(1, i) += 0.01F * target(0, i);
  target.row(0) *= 1.05F;
  Matrix3X<float> x = start;
  solver.solve({target, start, kStepOfCopies, kStepOfCopies}, {}, x);
  return x;
}

TEST(PreparedSolvers, HaveTheBitsOfASolverOfOnesOwn) {
  const ClothMesh mesh = sheet_of_copies();
  std::vector<bool> is_free(static_cast<std::size_t>(mesh.num_nodes()), true);
  is_free[0] = false;
  const SpringNetwork network = tension_of(mesh, 200);
  ImplicitSolver<float> own(network, mesh.masses, is_free);
  const Matrix3X<float> expected = pulled(own, mesh);
  EXPECT_GT((expected - mesh.rest_positions.cast<float>()).norm(), 0.01F);
  PreparedSolvers<float> prepared;
  for (int body = 0; body < 4; ++body) {
    const auto solver = prepared.make(network, mesh.masses, is_free);
    EXPECT_EQ(pulled(*solver, mesh), expected) << body;
  }
}

// One body after another of four kinds, which differ in one thing each.
TEST(PreparedSolvers, TellKindsApart) {
  const ClothMesh mesh = sheet_of_copies();
  const std::vector<bool> all_free(static_cast<std::size_t>(mesh.num_nodes()), true);
  std::vector<bool> one_pinned = all_free;
  one_pinned[5] = false;
  struct Kind {
    SpringNetwork network;
    VectorX<double> masses;
    std::vector<bool> is_free;
  };
  std::vector<Kind> kinds = {{tension_of(mesh, 200), mesh.masses, all_free},
                             {tension_of(mesh, 300), mesh.masses, all_free},
                             {tension_of(mesh, 200), 2 * mesh.masses, all_free},
                             {tension_of(mesh, 200), mesh.masses, one_pinned},
                             {tension_of(mesh, 200), mesh.masses, all_free}};
  kinds.back().network.rest_lengths[7] *= 1.01;
  PreparedSolvers<float> prepared;
  for (int round = 0; round < 4; ++round) {
    for (std::size_t k = 0; k < kinds.size(); ++k) {
      const auto& [network, masses, is_free] = kinds[k];
      const auto solver = prepared.make(network, masses, is_free);
      ImplicitSolver<float> own(network, masses, is_free);
      EXPECT_EQ(pulled(*solver, mesh), pulled(own, mesh)) << k;
    }
  }
}

// Rest lengths of a mesh at another place differ in their last bits.
TEST(PreparedSolvers, TakeMeshesAtOtherPlacesForAlike) {
  PreparedSolvers<float> prepared;
  const ClothMesh mesh = sheet_of_copies();
  const ClothMesh other = sheet_of_copies({3, 1, 7});
  ASSERT_NE(tension_of(mesh, 200).rest_lengths, tension_of(other, 200).rest_lengths);
  const std::vector<bool> all_free(static_cast<std::size_t>(mesh.num_nodes()), true);
  for (int body = 0; body < 2; ++body) {
    (void)prepared.make(tension_of(mesh, 200), mesh.masses, all_free);
  }
  EXPECT_EQ(prepared.num_shared(), 0);
  (void)prepared.make(tension_of(other, 200), mesh.masses, all_free);
  EXPECT_EQ(prepared.num_shared(), 1);
}

/// The changes that a body may make to its solver at run time.
const std::vector<std::function<void(ImplicitSolver<float>&, const ClothMesh&)>>& changes() {
  using Solver = ImplicitSolver<float>;
  static const std::vector<std::function<void(Solver&, const ClothMesh&)>> all = {
      [](Solver& solver, const ClothMesh&) { solver.set_rest_length(30, 31, 0.01); },
      [](Solver& solver, const ClothMesh& mesh) {
        std::vector<bool> is_free(static_cast<std::size_t>(mesh.num_nodes()), true);
        is_free[40] = false;
        solver.set_free(is_free);
      },
      // All springs of a node are gone, and its mass is another one: as after a tear, with no new node.
      [](Solver& solver, const ClothMesh& mesh) {
        std::vector<char> is_changed(static_cast<std::size_t>(mesh.num_nodes()), 0);
        is_changed[30] = 1;
        VectorX<double> masses = mesh.masses;
        masses[30] *= 0.5;
        solver.tear({}, is_changed, masses, {});
      }};
  return all;
}

// Neither solvers that were made before nor those that are made afterwards, nor the one that they are copies of.
TEST(PreparedSolvers, AreNotChangedWithACopy) {
  const ClothMesh mesh = sheet_of_copies();
  const std::vector<bool> is_free(static_cast<std::size_t>(mesh.num_nodes()), true);
  const SpringNetwork network = tension_of(mesh, 200);
  ImplicitSolver<float> own(network, mesh.masses, is_free);
  const Matrix3X<float> expected = pulled(own, mesh);
  for (const auto& change : changes()) {
    ImplicitSolver<float> own_changed(network, mesh.masses, is_free);
    change(own_changed, mesh);
    const Matrix3X<float> expected_changed = pulled(own_changed, mesh);
    EXPECT_NE(expected_changed, expected);
    for (std::size_t changed = 0; changed < 4; ++changed) {
      auto prepared = std::make_unique<PreparedSolvers<float>>();
      std::vector<std::unique_ptr<ImplicitSolver<float>>> solvers;
      for (int body = 0; body < 4; ++body) {
        solvers.push_back(prepared->make(network, mesh.masses, is_free));
      }
      EXPECT_EQ(prepared->num_shared(), 2);
      change(*solvers[changed], mesh);
      solvers.push_back(prepared->make(network, mesh.masses, is_free));
      EXPECT_EQ(prepared->num_shared(), 3);
      prepared.reset();  // copies outlive it
      for (std::size_t k = 0; k < solvers.size(); ++k) {
        EXPECT_EQ(pulled(*solvers[k], mesh), k == changed ? expected_changed : expected) << k;
      }
    }
  }
}

}  // namespace
}  // namespace weft::fast
