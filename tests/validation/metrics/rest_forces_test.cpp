#include <weft/validation/metrics/rest_forces.hpp>

#include <limits>

#include <gtest/gtest.h>

#include <weft/core/error.hpp>

namespace weft::validation {
namespace {

/// Two nodes in a row hang from two that are pinned, each by springs of 100 N/m: 1 m, 4 kg.
scenes::Scene hanging() {
  ClothGrid grid;
  grid.nodes = {2, 2};
  grid.stencil = GridStencil::k8Neighbour;
  grid.lumping = MassLumping::kUniform;
  grid.v_axis = {0, -1, 0};
  grid.total_mass = 4.0;
  scenes::Cloth cloth;
  cloth.name = "cloth";
  cloth.source = grid;
  cloth.pins = {scenes::EdgePin{1, 0}};
  cloth.laws = {{"gravity", {}, {{"acceleration", {0.0, -10.0, 0.0}}}},
                {"tension", {{"stretch"}}, {{"stiffness", {100.0}}}}};
  scenes::Scene scene;
  scene.name = "hanging";
  scene.cloths = {cloth};
  return scene;
}

scenes::SceneState state_of(const scenes::Scene& scene, double stretch) {
  const ClothMesh mesh = make_mesh(scene.cloths[0]);
  scenes::SceneState state;
  state.cloths.push_back({"cloth", mesh.rest_positions, Matrix3X<double>::Zero(3, 4)});
  for (int i = 0; i < 4; ++i) {
    if (mesh.rest_positions(1, i) < 0) state.cloths[0].positions(1, i) -= stretch;
  }
  return state;
}

TEST(RestForces, VanishWhereSpringsCarryTheWeight) {
  const scenes::Scene scene = hanging();
  // m g / k = 1 kg 10 m/s^2 / 100 N/m.
  const UnbalancedForces left = RestForces(scene, 1e-7).evaluate(state_of(scene, 0.1));
  EXPECT_LT(left.largest, 1e-12);
  EXPECT_EQ(left.num_nodes, 2);
}

TEST(RestForces, AreTheWeightWhereNothingIsStretched) {
  const scenes::Scene scene = hanging();
  const UnbalancedForces left = RestForces(scene, 1e-7).evaluate(state_of(scene, 0.0));
  EXPECT_NEAR(left.largest, 1.0, 1e-12);
  EXPECT_NEAR(left.mean, 1.0, 1e-12);
}

TEST(RestForces, DoNotDependOnVelocities) {
  const scenes::Scene scene = hanging();
  scenes::SceneState state = state_of(scene, 0.03);
  const RestForces forces(scene, 1e-7);
  const double still = forces.evaluate(state).largest;
  state.cloths[0].velocities.setConstant(7.0);
  EXPECT_EQ(forces.evaluate(state).largest, still);
  EXPECT_NEAR(still, 0.7, 1e-12);
}

TEST(RestForces, LeaveOutNodesNearAnObstacle) {
  scenes::Scene scene = hanging();
  scene.cloths[0].collision_margin = 0.01;
  scenes::Collider ball{.name = "ball", .shape = scenes::SphereShape{0.1}};
  ball.position = {0.5, -0.615, 0};
  scene.colliders = {ball};
  scenes::SceneState state = state_of(scene, 0.0);
  state.rigids.push_back({"ball", ball.position});
  EXPECT_EQ(RestForces(scene, 1e-7).evaluate(state).num_nodes, 1);
  state.rigids[0].position.y() -= 0.006;  // now 2.1 cm away
  EXPECT_EQ(RestForces(scene, 1e-7).evaluate(state).num_nodes, 2);
}

TEST(RestForces, RoundingIsThatOfThePrecision) {
  const scenes::Scene scene = hanging();
  const scenes::SceneState state = state_of(scene, 0.1);
  const double single = RestForces(scene, 1.2e-7).evaluate(state).rounding_largest;
  const double twice = RestForces(scene, 2.4e-7).evaluate(state).rounding_largest;
  EXPECT_GT(single, 0);
  EXPECT_LT(single, 1e-6);  // k eps x / (m g)
  EXPECT_NEAR(twice / single, 2.0, 1e-3);
}

TEST(RestForces, APlaceThatIsNoNumberIsSeen) {
  const scenes::Scene scene = hanging();
  scenes::SceneState state = state_of(scene, 0.1);
  state.cloths[0].positions(0, 3) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(std::isnan(RestForces(scene, 1e-7).evaluate(state).largest));
}

TEST(RestForces, RefuseWhatTheyCannotJudge) {
  scenes::Scene scene = hanging();
  EXPECT_THROW(RestForces(scene, 0.0), InvalidArgument);
  EXPECT_THROW((void)RestForces(scene, 1e-7).evaluate({}), InvalidArgument);
  scene.cloths[0].self_collision = true;
  EXPECT_THROW(RestForces(scene, 1e-7), InvalidArgument);
  scene = hanging();
  scene.cloths[0].laws.erase(scene.cloths[0].laws.begin());
  EXPECT_THROW(RestForces(scene, 1e-7), InvalidArgument);
}

}  // namespace
}  // namespace weft::validation
