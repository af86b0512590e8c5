// Controllers by themselves: what they ask for in a given state.
#include <gtest/gtest.h>

#include <weft/core/error.hpp>
#include <weft/scenes/controllers/controller_manager.hpp>

namespace weft::scenes {
namespace {

Path still(const Vector3<double>& place) {
  return {.times = {0.0, 1.0}, .points = {place, place}};
}

Scene small_scene() {
  Scene scene;
  scene.name = "small";
  Cloth& cloth = scene.cloths.emplace_back();
  cloth.name = "cloth";
  cloth.grid().nodes = {4, 5};
  cloth.grid().size = {0.6, 0.8};
  cloth.regions = {{"core", {BoxPin{{-0.2, -1, -0.3}, {0.2, 1, 0.3}}}}};
  return scene;
}

SceneState state_of(const Scene& scene) {
  SceneState state;
  for (const Cloth& cloth : scene.cloths) {
    const ClothMesh mesh = make_mesh(cloth);
    state.cloths.push_back(
        {cloth.name, mesh.rest_positions, Matrix3X<double>::Zero(3, mesh.num_nodes())});
  }
  for (const Collider& collider : scene.colliders) state.rigids.push_back({collider.name});
  return state;
}

/// Sum and moment about the origin of the forces on the first cloth.
struct Wrench {
  Vector3<double> force{0, 0, 0};
  Vector3<double> moment{0, 0, 0};
};

Wrench wrench_of(const Scene& scene, const SceneState& state, double end_time = 0.01) {
  ControllerManager manager(scene);
  const StepCommands& commands = manager.steer(state, end_time);
  Wrench wrench;
  const Matrix3X<double>& forces = commands.cloths[0].node_forces;
  for (Eigen::Index i = 0; i < forces.cols(); ++i) {
    wrench.force += forces.col(i);
    wrench.moment += state.cloths[0].positions.col(i).cross(forces.col(i));
  }
  return wrench;
}

TEST(ControllerManager, HasNothingToDoInASceneWithoutPathsAndControllers) {
  EXPECT_FALSE(ControllerManager(small_scene()).is_needed());
}

TEST(ControllerManager, AnEdgeOnAPathKeepsItsShapeAndFollows) {
  Scene scene = small_scene();
  const Path path{.times = {0, 1, 2}, .points = {{0, 0, 0}, {1, 1, 0}, {2, 0, 0}}};
  scene.cloths[0].moving_pins = {{.nodes = EdgePin{.axis = 0, .side = 0}, .path = path}};
  const ClothMesh mesh = make_mesh(scene.cloths[0]);
  ControllerManager manager(scene);
  const StepCommands& commands = manager.steer(state_of(scene), 0.7);
  const Matrix3X<double>& led = commands.cloths[0].pinned_positions;
  ASSERT_EQ(led.cols(), 5);
  const Vector3<double> place = PathMotion(path).position(0.7);
  for (Eigen::Index i = 0; i < led.cols(); ++i) {
    const Vector3<double> rest = mesh.rest_positions.col(mesh.pinned[static_cast<std::size_t>(i)]);
    EXPECT_EQ(led.col(i), Vector3<double>(place + (rest - path.points[0])));
  }
}

TEST(ControllerManager, PinsWithoutAPathGoOnBesideThoseWithOne) {
  Scene scene = small_scene();
  const Path path{.times = {0, 1}, .points = {{0, 0, 0}, {1, 1, 0}}};
  scene.cloths[0].pins = {CornerPin{-1, -1}};
  scene.cloths[0].moving_pins = {{.nodes = CornerPin{-1, 0}, .velocity = {0, 2, 0}},
                                 {.nodes = EdgePin{.axis = 0, .side = 0}, .path = path}};
  const ClothMesh mesh = make_mesh(scene.cloths[0]);
  ControllerManager manager(scene);
  const StepCommands& commands = manager.steer(state_of(scene), 0.25);
  for (std::size_t i = 0; i < mesh.pinned.size(); ++i) {
    const Vector3<double> rest = mesh.rest_positions.col(mesh.pinned[i]);
    const Vector3<double> led =
        commands.cloths[0].pinned_positions.col(static_cast<Eigen::Index>(i));
    if (mesh.pinned[i] == 19) {
      EXPECT_EQ(led, rest);
    }
    if (mesh.pinned[i] == 3) {
      EXPECT_EQ(led, Vector3<double>(rest + Vector3<double>(0, 0.5, 0)));
    }
  }
}

TEST(Seek, PushesTowardsTheTargetWithAtMostItsForce) {
  Scene scene = small_scene();
  scene.controllers = {Seek{.cloth = "cloth",
                            .region = "core",
                            .target = still({3, 1, 4}),
                            .front = {0.6, 0, 0.8},
                            .force = 2.5,
                            .torque = 1.0}};
  const Wrench wrench = wrench_of(scene, state_of(scene));
  // Already looking at the target: no torque. Rounding only.
  EXPECT_LT((wrench.force - 2.5 * Vector3<double>(0.6, 0, 0.8)).norm(), 1e-14);
  EXPECT_LT(wrench.moment.norm(), 1e-14);
}

TEST(Seek, TurnsItsFrontTowardsTheTarget) {
  Scene scene = small_scene();
  scene.controllers = {Seek{.cloth = "cloth",
                            .region = "core",
                            .target = still({5, 0, 0}),
                            .front = {0, 0, 1},
                            .force = 0.0,
                            .torque = 0.3}};
  // From +z to +x is a positive turn about +y.
  EXPECT_NEAR(wrench_of(scene, state_of(scene)).moment.y(), 0.3, 1e-14);
  scene.controllers = {Seek{.cloth = "cloth",
                            .region = "core",
                            .target = still({-5, 0, 0}),
                            .front = {0, 0, 1},
                            .force = 0.0,
                            .torque = 0.3}};
  EXPECT_NEAR(wrench_of(scene, state_of(scene)).moment.y(), -0.3, 1e-14);
}

TEST(Seek, BrakesWhatIsFasterThanItsSpeed) {
  Scene scene = small_scene();
  scene.controllers = {Seek{.cloth = "cloth",
                            .region = "core",
                            .target = still({5, 0, 0}),
                            .front = {1, 0, 0},
                            .speed = 0.5}};
  SceneState state = state_of(scene);
  state.cloths[0].velocities.row(0).setConstant(2.0);
  EXPECT_LT(wrench_of(scene, state).force.x(), 0);
}

TEST(Roll, TurnsAboutTheAxisAcrossTheWay) {
  Scene scene = small_scene();
  scene.controllers = {Roll{.cloth = "cloth", .target = still({9, 0, 0}), .torque = 0.7}};
  const Wrench wrench = wrench_of(scene, state_of(scene));
  EXPECT_LT(wrench.force.norm(), 1e-14);
  EXPECT_LT((wrench.moment - Vector3<double>(0, 0, -0.7)).norm(), 1e-14);
}

TEST(Roll, RestsAtItsRate) {
  Scene scene = small_scene();
  scene.controllers = {
      Roll{.cloth = "cloth", .target = still({9, 0, 0}), .turn_rate = 2.0, .torque = 0.7}};
  SceneState state = state_of(scene);
  const Vector3<double> omega(0, 0, -2.0);
  for (Eigen::Index i = 0; i < state.cloths[0].positions.cols(); ++i) {
    state.cloths[0].velocities.col(i) =
        omega.cross(Vector3<double>(state.cloths[0].positions.col(i)));
  }
  EXPECT_LT(wrench_of(scene, state).moment.norm(), 1e-14);
}

TEST(ControllerManager, RefusesControllersThatDoNotFitTheScene) {
  Scene scene = small_scene();
  scene.controllers = {Roll{.cloth = "nobody", .target = still({9, 0, 0})}};
  EXPECT_THROW(ControllerManager{scene}, InvalidArgument);
  scene.controllers = {Seek{.cloth = "cloth", .region = "none", .target = still({9, 0, 0})}};
  EXPECT_THROW(ControllerManager{scene}, InvalidArgument);
  scene.controllers = {Roll{.cloth = "cloth", .target = still({9, 0, 0}), .turn_rate = 0}};
  EXPECT_THROW(ControllerManager{scene}, InvalidArgument);
}

}  // namespace
}  // namespace weft::scenes
