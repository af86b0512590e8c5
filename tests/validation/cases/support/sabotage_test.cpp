#include <weft/validation/cases/support/sabotage.hpp>

#include <gtest/gtest.h>

#include <weft/custom_forces/registry.hpp>
#include <weft/scenes/catalog.hpp>

namespace weft::validation {
namespace {

scenes::Scene short_hang() {
  scenes::Scene scene = scenes::load_scene("hang");
  scene.world.duration = 0.1;
  return scene;
}

/// Largest difference of the last frames of a run with and without a mistake [m].
double effect(const Sabotage& sabotage) {
  const scenes::Scene scene = short_hang();
  const auto right = run_sabotaged(scene, Sabotage{"none"}, scene.world.duration);
  const auto wrong = run_sabotaged(scene, sabotage, scene.world.duration);
  return (right.back().cloths[0].positions - wrong.back().cloths[0].positions)
      .cwiseAbs()
      .maxCoeff();
}

TEST(Sabotage, NoneChangesNothing) {
  EXPECT_EQ(effect(Sabotage{"none"}), 0.0);
}

TEST(Sabotage, EachChangesTheRun) {
  for (const Sabotage& sabotage :
       {stiffness_scaled(1.01), damping_sign(), one_step_dropped(), initial_velocity_unset()}) {
    EXPECT_GT(effect(sabotage), 0.0) << sabotage.name;
  }
}

TEST(Sabotage, NegatedLawHasTheOppositeForceAndDecay) {
  ClothGrid grid;
  grid.nodes = {3, 3};
  const ClothMesh mesh = make_cloth_grid(grid);
  const forces::LawSpecification damping{"velocity_damping", {}, {{"rate", {2.0}}}};
  const auto law = forces::make_law<double>(damping, mesh);
  const auto wrong = negated(forces::make_law<double>(damping, mesh));
  const Matrix3X<double> velocities = Matrix3X<double>::Constant(3, 9, 0.5);
  const forces::State<double> state{mesh.rest_positions, velocities, mesh.masses};
  Matrix3X<double> scratch(3, 0);
  Matrix3X<double> a = Matrix3X<double>::Zero(3, 9);
  Matrix3X<double> b = Matrix3X<double>::Zero(3, 9);
  law->add_forces(state, scratch, a);
  wrong->add_forces(state, scratch, b);
  EXPECT_GT(a.norm(), 0.0);
  EXPECT_EQ((a + b).norm(), 0.0);
  Matrix3X<double> faster = velocities;
  wrong->advance_velocities(state, 0.1, faster);
  EXPECT_GT(faster(0, 0), velocities(0, 0));
}

}  // namespace
}  // namespace weft::validation
