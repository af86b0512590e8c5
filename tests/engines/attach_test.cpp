// A cloth that is attached to colliders: exactly to one that is led, by springs to one that moves freely.
#include <gtest/gtest.h>

#include <weft/core/error.hpp>
#include <weft/engines/engine_table.hpp>
#include <weft/scenes/controllers/attach.hpp>
#include <weft/scenes/controllers/collider_path.hpp>
#include <weft/scenes/controllers/pin_path.hpp>

namespace weft::scenes {
namespace {

/// A strip of 0.2 m x 0.4 m that hangs from its upper edge at y = 1 m.
Scene strip() {
  Scene scene;
  scene.name = "strip";
  scene.world.time_step = 1e-3;
  Cloth& cloth = scene.cloths.emplace_back();
  cloth.name = "strip";
  cloth.grid().nodes = {5, 9};
  cloth.grid().size = {0.2, 0.4};
  cloth.grid().center = {0, 0.8, 0};
  cloth.grid().u_axis = {1, 0, 0};
  cloth.grid().v_axis = {0, -1, 0};
  cloth.grid().total_mass = 0.1;
  cloth.regions = {{"hem", {EdgePin{.axis = 1, .side = -1}}}};
  cloth.laws = {{"tension", {}, {{"stiffness", {200.0}}}},
                {"spring_damping", {}, {{"damping", {0.05}}}}};
  return scene;
}

Collider ball(const Vector3<double>& position, std::optional<double> mass) {
  Collider collider;
  collider.name = "ball";
  collider.shape = SphereShape{0.05};
  collider.position = position;
  collider.mass = mass;
  return collider;
}

std::unique_ptr<Simulator> loaded(std::string_view name, const Scene& scene) {
  const auto precision =
      name == "reference" ? StoredPrecision::kFloat64 : StoredPrecision::kFloat32;
  auto simulator = find_engine(name, precision)->make();
  simulator->load(scene);
  return simulator;
}

class Attachments : public testing::TestWithParam<const char*> {};

TEST_P(Attachments, APinToALedColliderKeepsItsPlaceThere) {
  Scene scene = strip();
  scene.colliders = {ball({0, 0, 0}, std::nullopt)};
  scene.colliders[0].path = Path{.times = {0, 0.2, 0.4},
                                 .points = {{0, 1.2, 0}, {0.1, 1.25, 0.1}, {0.3, 1.2, 0}},
                                 .turns = {0, 0.4, 1.0}};
  scene.colliders[0].position = {0, 1.2, 0};
  scene.cloths[0].moving_pins = {{.nodes = EdgePin{.axis = 1, .side = 0}, .to = "ball"}};
  const ClothMesh mesh = make_mesh(scene.cloths[0]);
  const auto simulator = loaded(GetParam(), scene);
  const Pose start = start_pose(scene.colliders[0]);
  for (int step = 1; step <= 400; ++step) {
    ASSERT_FALSE(simulator->step(scene.world.time_step).blow_up);
    const SceneState& state = simulator->state();
    const Pose now = PathMotion(*scene.colliders[0].path).pose(state.time);
    for (const int node : mesh.pinned) {
      // Exact, but for the rounding of a place some 1 m from the origin to single precision.
      const Vector3<double> place = carried(start, now, mesh.rest_positions.col(node));
      ASSERT_LT((state.cloths[0].positions.col(node) - place).norm(), 2e-7) << step;
    }
  }
}

TEST_P(Attachments, SpringsCarryTheWeightOfABall) {
  Scene scene = strip();
  const double mass = 0.05;
  const double stiffness = 40.0;
  scene.cloths[0].pins = {EdgePin{.axis = 1, .side = 0}};
  scene.cloths[0].laws.push_back({"velocity_damping", {}, {{"rate", {4.0}}}});
  scene.colliders = {ball({0, 0.4, 0}, mass)};
  scene.controllers = {Attach{"strip", "hem", "ball", stiffness, 0.1}};
  const auto simulator = loaded(GetParam(), scene);
  for (int step = 1; step <= 6000; ++step) {
    ASSERT_FALSE(simulator->step(scene.world.time_step).blow_up);
  }
  const SceneState& state = simulator->state();
  EXPECT_LT(state.rigids[0].velocity.norm(), 1e-3);
  const ClothMesh mesh = make_mesh(scene.cloths[0]);
  double pull = 0;  // [N] of all springs
  for (const int node : mesh.node_sets.at(0).nodes) {
    const Vector3<double> arm = mesh.rest_positions.col(node) - Vector3<double>(0, 0.4, 0);
    const Vector3<double> place = state.rigids[0].position + state.rigids[0].orientation * arm;
    pull += stiffness * (state.cloths[0].positions.col(node) - place).y();
  }
  // At rest but for what is left of the swinging: 1e-3 m/s at about 2 Hz is 0.1 % of g.
  EXPECT_NEAR(pull, mass * 9.81, 0.005 * mass * 9.81);
}

TEST_P(Attachments, SpringsKeepTheMomenta) {
  Scene scene = strip();
  scene.world.gravity.setZero();
  scene.colliders = {ball({0.1, 0.3, 0}, 0.08)};
  scene.colliders[0].velocity = {0.5, -1.0, 0.3};
  scene.controllers = {Attach{"strip", "hem", "ball", 60.0, 0.2}};
  const ClothMesh mesh = make_mesh(scene.cloths[0]);
  const double inertia = 0.4 * 0.08 * 0.05 * 0.05;
  const auto momenta = [&](const SceneState& state) {
    Eigen::Matrix<double, 6, 1> sum;
    const RigidState& body = state.rigids[0];
    sum << 0.08 * body.velocity,
        0.08 * body.position.cross(body.velocity) + inertia * body.angular_velocity;
    for (int i = 0; i < mesh.num_nodes(); ++i) {
      const Vector3<double> momentum = mesh.masses[i] * state.cloths[0].velocities.col(i);
      sum.head<3>() += momentum;
      sum.tail<3>() += Vector3<double>(state.cloths[0].positions.col(i)).cross(momentum);
    }
    return sum;
  };
  const auto simulator = loaded(GetParam(), scene);
  const Eigen::Matrix<double, 6, 1> before = momenta(simulator->state());
  for (int step = 1; step <= 300; ++step) {
    ASSERT_FALSE(simulator->step(scene.world.time_step).blow_up);
  }
  EXPECT_GT(simulator->state().cloths[0].velocities.col(44).norm(),
            0.05);  // it is being drawn along
  const Eigen::Matrix<double, 6, 1> change = momenta(simulator->state()) - before;
  // Velocities are rounded to single precision in each of 300 steps: 300 eps = 3.6e-5, with a margin.
  EXPECT_LT(change.head<3>().norm(), 1e-4 * before.head<3>().norm());
  // The ball's place is half a step away from the one at which the forces acted: of first order.
  EXPECT_LT(change.tail<3>().norm(), 5e-3 * before.tail<3>().norm());
}

INSTANTIATE_TEST_SUITE_P(Engines, Attachments, testing::Values("bullet_forces", "reference"),
                         [](const auto& info) { return std::string(info.param); });

TEST(Attach, RefusesWhatIsNotThere) {
  Scene scene = strip();
  scene.colliders = {ball({0, 0.4, 0}, 0.1)};
  EXPECT_THROW(AttachController({"strip", "hem", "bell", 1.0, 0.0}, 0, scene), InvalidArgument);
  EXPECT_THROW(AttachController({"strip", "him", "ball", 1.0, 0.0}, 0, scene), InvalidArgument);
  EXPECT_THROW(AttachController({"strip", "hem", "ball", 0.0, 0.0}, 0, scene), InvalidArgument);
  scene.cloths[0].moving_pins = {{.nodes = EdgePin{.axis = 1, .side = 0}, .to = "ball"}};
  EXPECT_THROW(PinPathController(scene, 0), InvalidArgument);  // it has a mass
}

}  // namespace
}  // namespace weft::scenes
