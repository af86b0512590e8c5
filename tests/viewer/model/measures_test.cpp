#include <weft/viewer/model/measures.hpp>

#include <gtest/gtest.h>

#include <cmath>

#include <weft/mesh/cutting/tear.hpp>

namespace weft::viewer {
namespace {

scenes::Scene sheet() {
  scenes::Scene scene;
  scenes::Cloth& cloth = scene.cloths.emplace_back();
  cloth.name = "sheet";
  cloth.grid().nodes = {3, 3};
  cloth.grid().size = {1.0, 1.0};
  cloth.grid().total_mass = 0.4;
  cloth.laws = {{"gravity", {}, {{"acceleration", {0.0, -10.0, 0.0}}}},
                {"tension", {"stretch"}, {{"stiffness", {30.0}}}}};
  return scene;
}

scenes::SceneState measured_at_rest(const scenes::Scene& scene) {
  scenes::SceneState state;
  for (const scenes::Cloth& cloth : scene.cloths) {
    const ClothMesh mesh = scenes::make_mesh(cloth);
    state.cloths.push_back(
        {cloth.name, mesh.rest_positions, Matrix3X<double>::Zero(3, mesh.num_nodes())});
  }
  return state;
}

TEST(Measures, EnergiesAreThoseOfTheLaws) {
  const scenes::Scene scene = sheet();
  Meter meter(scene);
  scenes::SceneState state = measured_at_rest(scene);
  const double rest = meter.measure(state).potential_energy;
  state.cloths[0].positions.row(1).array() += 2.0;
  state.cloths[0].velocities.row(0).array() = 3.0;
  const Measures measures = meter.measure(state);
  EXPECT_NEAR(measures.potential_energy - rest, 0.4 * 10.0 * 2.0, 1e-12);
  EXPECT_NEAR(measures.kinetic_energy, 0.5 * 0.4 * 9.0, 1e-12);
  EXPECT_NEAR(measures.largest_strain, 0.0, 1e-12);
}

TEST(Measures, FindsTheWorstNode) {
  const scenes::Scene scene = sheet();
  Meter meter(scene);
  scenes::SceneState state = measured_at_rest(scene);
  // The middle node goes sideways by a fifth of a thread: one thread is longer, one shorter.
  const Vector3<double> way = state.cloths[0].positions.col(1) - state.cloths[0].positions.col(0);
  state.cloths[0].positions.col(8) += 0.2 * way;
  const Measures measures = meter.measure(state);
  ASSERT_TRUE(measures.worst);
  EXPECT_NEAR(measures.worst->strain, 0.2, 1e-12);
  EXPECT_NEAR(measures.largest_strain, 0.2, 1e-12);
  EXPECT_TRUE(measures.worst->id.node == 8 || measures.worst->id.node == 7);
  EXPECT_EQ(meter.strains(state).at(0).size(), 9);
}

TEST(Measures, ATornClothHasNoEnergy) {
  const scenes::Scene scene = sheet();
  Meter meter(scene);
  scenes::SceneState state = measured_at_rest(scene);
  const ClothMesh mesh = scenes::make_mesh(scene.cloths[0]);
  auto topology = std::make_shared<scenes::ClothTopology>();
  topology->triangles = mesh.triangles;
  topology->origins = {4};
  state.cloths[0].topology = topology;
  state.cloths[0].positions.conservativeResize(3, 10);
  state.cloths[0].positions.col(9) = state.cloths[0].positions.col(4);
  state.cloths[0].velocities = Matrix3X<double>::Zero(3, 10);
  const Measures measures = meter.measure(state);
  EXPECT_TRUE(std::isnan(measures.kinetic_energy));
  EXPECT_TRUE(std::isnan(measures.potential_energy));
}

}  // namespace
}  // namespace weft::viewer
