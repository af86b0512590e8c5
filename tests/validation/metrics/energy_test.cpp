#include <gtest/gtest.h>

#include <weft/core/error.hpp>
#include <weft/validation/metrics/energy.hpp>

#include "tests/validation/metrics/test_shapes.hpp"

namespace weft::validation {
namespace {

using forces::LawSpecification;

constexpr double kGravity = 9.81;    // [m/s^2]
constexpr double kStiffness = 40.0;  // [N/m]

LawSpecification gravity_law() {
  return {"gravity", {}, {{"acceleration", {0, -kGravity, 0}}}};
}
LawSpecification tension_law() {
  return {"tension", {"stretch"}, {{"stiffness", {kStiffness}}}};
}

/// A 2 m x 2 m cloth of 3 x 3 nodes and 4 kg under the given laws.
scenes::Scene cloth_scene(std::vector<LawSpecification> laws) {
  scenes::Scene scene;
  scenes::Cloth cloth;
  cloth.name = "cloth";
  cloth.grid().nodes = {3, 3};
  cloth.grid().size = {2.0, 2.0};
  cloth.grid().total_mass = 4.0;
  cloth.laws = std::move(laws);
  scene.cloths = {cloth};
  return scene;
}

scenes::SceneState rest_state(const scenes::Scene& scene) {
  scenes::SceneState state;
  for (const scenes::Cloth& cloth : scene.cloths) {
    const ClothMesh mesh = scenes::make_mesh(cloth);
    state.cloths.push_back(
        {cloth.name, mesh.rest_positions, Matrix3X<double>::Zero(3, mesh.num_nodes())});
  }
  for (const scenes::Collider& c : scene.colliders) {
    state.rigids.push_back({c.name, c.position, c.orientation, c.velocity, c.angular_velocity});
  }
  return state;
}

TEST(Energy, OfATranslatingClothIsHalfMVSquared) {
  const scenes::Scene scene = cloth_scene({});
  scenes::SceneState state = rest_state(scene);
  state.cloths[0].velocities.colwise() = Vector3<double>(1, 2, -2);
  const Energy e = SceneEnergy(scene).evaluate(state);
  EXPECT_TRUE(e.finite);
  EXPECT_NEAR(e.kinetic_cloths, 18.0, 18 * kRoundoff);
  EXPECT_LT((e.momentum - Vector3<double>(4, 8, -8)).norm(), 10 * kRoundoff);
  EXPECT_LT(e.center_of_mass.norm(), kRoundoff);
  EXPECT_LT(e.angular_momentum.norm(), 10 * kRoundoff);
  EXPECT_EQ(e.total(), e.kinetic());
}

TEST(Energy, OfASpinningClothIsHalfIOmegaSquared) {
  const scenes::Scene scene = cloth_scene({});
  scenes::SceneState state = rest_state(scene);
  const ClothMesh mesh = scenes::make_mesh(scene.cloths[0]);
  const Vector3<double> spin(0, 3, 0);
  double inertia = 0.0;
  for (int i = 0; i < mesh.num_nodes(); ++i) {
    const Vector3<double> r = mesh.rest_positions.col(i);
    state.cloths[0].velocities.col(i) = spin.cross(r);
    inertia += mesh.masses[i] * r.squaredNorm();
  }
  const Energy e = SceneEnergy(scene).evaluate(state);
  EXPECT_NEAR(e.kinetic_cloths, 0.5 * inertia * 9.0, 100 * kRoundoff);
  EXPECT_LT((e.angular_momentum - inertia * spin).norm(), 100 * kRoundoff);
  EXPECT_LT(e.momentum.norm(), 10 * kRoundoff);
}

TEST(Energy, AngularMomentumIsAboutTheOrigin) {
  const scenes::Scene scene = cloth_scene({});
  scenes::SceneState state = rest_state(scene);
  state.cloths[0].positions.colwise() += Vector3<double>(0, 0, 5);
  state.cloths[0].velocities.colwise() = Vector3<double>(2, 0, 0);
  const Energy e = SceneEnergy(scene).evaluate(state);
  EXPECT_LT((e.angular_momentum - Vector3<double>(0, 40, 0)).norm(), 100 * kRoundoff);
  EXPECT_LT((e.center_of_mass - Vector3<double>(0, 0, 5)).norm(), 10 * kRoundoff);
}

TEST(Energy, GravityAndTensionGoToTheirOwnAccounts) {
  const scenes::Scene scene = cloth_scene({gravity_law(), tension_law()});
  scenes::SceneState state = rest_state(scene);
  state.cloths[0].positions.row(1).array() += 3.0;
  state.cloths[0].positions.row(0) *= 1.1;  // six springs of 1 m become 1.1 m
  const Energy e = SceneEnergy(scene).evaluate(state);
  EXPECT_NEAR(e.gravitational, 4.0 * kGravity * 3.0, 1000 * kRoundoff);
  EXPECT_NEAR(e.elastic, 6 * 0.5 * kStiffness * 0.01, 10 * kRoundoff);
  EXPECT_NEAR(e.total(), e.gravitational + e.elastic, kRoundoff);
  EXPECT_EQ(e.non_conservative_power, 0.0);
}

TEST(Energy, DampersShowAsPowerNotAsStore) {
  const scenes::Scene scene = cloth_scene({{"velocity_damping", {}, {{"rate", {0.5}}}}});
  scenes::SceneState state = rest_state(scene);
  state.cloths[0].velocities.colwise() = Vector3<double>(2, 0, 0);
  const Energy e = SceneEnergy(scene).evaluate(state);
  EXPECT_EQ(e.elastic, 0.0);
  EXPECT_NEAR(e.non_conservative_power, -0.5 * 4.0 * 4.0, 10 * kRoundoff);  // -rate m v^2
}

TEST(Energy, IsConstantInFreeFall) {
  scenes::Scene scene = cloth_scene({gravity_law(), tension_law()});
  scene.colliders.push_back({.name = "ball", .shape = scenes::SphereShape{0.5}, .mass = 2.0});
  const SceneEnergy energy(scene);
  EXPECT_NEAR(energy.mass(), 6.0, kRoundoff * 6);
  const double before = energy.evaluate(rest_state(scene)).total();
  for (const double t : {0.5, 1.0, 2.0}) {
    scenes::SceneState state = rest_state(scene);
    const double drop = -0.5 * kGravity * t * t;
    state.cloths[0].positions.row(1).array() += drop;
    state.cloths[0].velocities.row(1).setConstant(-kGravity * t);
    state.rigids[0].position.y() += drop;
    state.rigids[0].velocity.y() = -kGravity * t;
    const Energy e = energy.evaluate(state);
    EXPECT_NEAR(e.total(), before, e.kinetic() * kRoundoff);
    EXPECT_NEAR(e.center_of_mass.y(), drop, 100 * kRoundoff);
    EXPECT_LT((e.momentum - Vector3<double>(0, -6 * kGravity * t, 0)).norm(), 1000 * kRoundoff);
  }
}

TEST(Energy, OfRigidBodiesTurnsTheirInertiaWithThem) {
  scenes::Scene scene;
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(std::numbers::pi / 2, Vector3<double>::UnitZ()));
  scene.colliders.push_back({.name = "box",
                             .shape = scenes::BoxShape{{1, 2, 3}},
                             .orientation = turn,
                             .mass = 3.0,
                             .angular_velocity = {2, 0, 0}});
  scene.colliders.push_back({.name = "ball",
                             .shape = scenes::SphereShape{2.0},
                             .mass = 5.0,
                             .angular_velocity = {0, 0, 1}});
  scene.colliders.push_back({.name = "floor",
                             .shape = scenes::PlaneShape{},
                             .mass = std::nullopt,
                             .velocity = {9, 9, 9}});
  const Energy e = SceneEnergy(scene).evaluate(rest_state(scene));
  // World x is the box's -y: I = m / 3 (1 + 9) = 10 kg m^2. The ball: 0.4 * 5 * 4 = 8 kg m^2. The
  // floor is fixed.
  EXPECT_NEAR(e.kinetic_rigids, 0.5 * 10 * 4 + 0.5 * 8, 100 * kRoundoff);
  EXPECT_LT((e.angular_momentum - Vector3<double>(20, 0, 8)).norm(), 100 * kRoundoff);
  EXPECT_EQ(e.momentum.norm(), 0.0);
}

TEST(Energy, OfNonFiniteStatesIsNaNAndFlagged) {
  scenes::Scene scene = cloth_scene({tension_law()});
  scene.colliders.push_back({.name = "ball", .shape = scenes::SphereShape{0.5}, .mass = 2.0});
  const SceneEnergy energy(scene);
  scenes::SceneState bad_node = rest_state(scene);
  bad_node.cloths[0].velocities(1, 3) = kNaN;
  scenes::SceneState bad_ball = rest_state(scene);
  bad_ball.rigids[0].position.x() = kInfinity;
  for (const scenes::SceneState& state : {bad_node, bad_ball}) {
    const Energy e = energy.evaluate(state);
    EXPECT_FALSE(e.finite);
    EXPECT_TRUE(std::isnan(e.total()));
    EXPECT_TRUE(std::isnan(e.elastic));
    EXPECT_TRUE(e.momentum.hasNaN());
    EXPECT_TRUE(e.angular_momentum.hasNaN());
  }
}

TEST(Energy, WithoutMassThereIsNoCentre) {
  const scenes::Scene scene;
  const Energy e = SceneEnergy(scene).evaluate({});
  EXPECT_EQ(e.total(), 0.0);
  EXPECT_TRUE(e.center_of_mass.hasNaN());
}

TEST(Energy, RefusesOtherStatesUnknownLawsAndDynamicPlanes) {
  const scenes::Scene scene = cloth_scene({});
  const SceneEnergy energy(scene);
  scenes::SceneState state = rest_state(scene);
  state.cloths[0].velocities.conservativeResize(3, 8);
  EXPECT_THROW((void)energy.evaluate(state), InvalidArgument);
  EXPECT_THROW((void)energy.evaluate({}), InvalidArgument);
  EXPECT_THROW(SceneEnergy(cloth_scene({{"no_such_law", {}, {}}})), InvalidArgument);
  scenes::Scene floor;
  floor.colliders.push_back({.name = "floor", .shape = scenes::PlaneShape{}, .mass = 1.0});
  EXPECT_THROW(SceneEnergy{floor}, InvalidArgument);
}

}  // namespace
}  // namespace weft::validation
