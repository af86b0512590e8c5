#include <weft/viewer/live/pull.hpp>

#include <gtest/gtest.h>

namespace weft::viewer {
namespace {

constexpr double kStep = 1e-3;  // [s]

scenes::Scene sheet_and_ball() {
  scenes::Scene scene;
  scenes::Cloth& cloth = scene.cloths.emplace_back();
  cloth.name = "sheet";
  cloth.grid().nodes = {11, 11};
  cloth.grid().size = {1.0, 1.0};
  cloth.grid().total_mass = 0.2;
  cloth.pins = {scenes::CornerPin{}};
  scenes::Collider& ball = scene.colliders.emplace_back();
  ball.name = "ball";
  ball.shape = scenes::SphereShape{0.1};
  ball.mass = 3.0;
  return scene;
}

struct Steered {
  Steered() : forces(scene, kStep) {
    const ClothMesh mesh = scenes::make_mesh(scene.cloths[0]);
    state.cloths.push_back(
        {"sheet", mesh.rest_positions, Matrix3X<double>::Zero(3, mesh.num_nodes())});
    state.rigids.push_back({"ball"});
  }
  scenes::StepCommands steer() {
    scenes::StepCommands commands;
    commands.cloths.resize(1);
    commands.colliders.resize(1);
    commands.pushes.resize(1);
    forces.steer(state, kStep, commands);
    return commands;
  }
  scenes::Scene scene = sheet_and_ball();
  scenes::SceneState state;
  WindowForces forces;
};

TEST(WindowForce, AsksForNothingByItself) {
  Steered steered;
  const scenes::StepCommands commands = steered.steer();
  EXPECT_EQ(commands.cloths[0].node_forces.cols(), 0);
  EXPECT_EQ(commands.pushes[0].force, Vector3<double>(0, 0, 0));
  EXPECT_EQ(steered.forces.pull_force(), 0.0);
}

TEST(WindowForce, PullsTowardsTheTargetAndSaysHowStrongly) {
  Steered steered;
  const Vector3<double> place = steered.state.cloths[0].positions.col(60);
  steered.forces.set_pull(Pull{{0, 60}, place + Vector3<double>(0, 1e-4, 0)});
  const scenes::StepCommands commands = steered.steer();
  const Vector3<double> sum = commands.cloths[0].node_forces.rowwise().sum();
  EXPECT_GT(sum.y(), 0.0);
  EXPECT_NEAR(sum.x(), 0.0, 1e-15);
  EXPECT_NEAR(sum.norm(), steered.forces.pull_force(), 1e-12);
  EXPECT_GT(commands.cloths[0].node_forces.col(60).y(), 0.0);
  steered.forces.set_pull(std::nullopt);
  EXPECT_EQ(steered.steer().cloths[0].node_forces.cols(), 0);
  EXPECT_EQ(steered.forces.pull_force(), 0.0);
}

TEST(WindowForce, IsHeldByTheMassOfTheCloth) {
  Steered steered;
  EXPECT_NEAR(steered.forces.largest_force(0), 3.0 * 9.81 * 0.2, 1e-12);
  steered.forces.set_pull(Pull{{0, 60}, {0, 1e6, 0}});
  const Vector3<double> sum = steered.steer().cloths[0].node_forces.rowwise().sum();
  EXPECT_NEAR(sum.norm(), steered.forces.largest_force(0), 1e-9);
  EXPECT_NEAR(steered.forces.pull_force(), steered.forces.largest_force(0), 1e-9);
}

TEST(WindowForce, APinAloneIsNotPulled) {
  Steered steered;
  steered.forces.set_pull(Pull{{0, 0}, {0, 5, 0}});
  EXPECT_EQ(steered.steer().cloths[0].node_forces.cols(), 0);
}

TEST(WindowForce, GravityOfRigidBodiesIsTheirMassTimesTheChange) {
  Steered steered;
  steered.forces.set_added_gravity({2.0, 0.0, 0.0});
  EXPECT_EQ(steered.steer().pushes[0].force, Vector3<double>(6.0, 0.0, 0.0));
}

TEST(WindowForce, MovesAColliderWithoutAMassNoFasterThanItMay) {
  Steered steered;
  steered.scene.colliders[0].mass.reset();
  steered.scene.colliders[0].position = {1, 2, 3};
  WindowForces hand(steered.scene, kStep);
  const auto lead = [&] {
    scenes::StepCommands commands;
    commands.cloths.resize(1);
    commands.colliders.resize(1);
    commands.pushes.resize(1);
    hand.steer(steered.state, kStep, commands);
    return commands.colliders[0];
  };
  EXPECT_FALSE(lead()) << "nobody moves it";
  hand.set_carry(Carry{0, {1, 2, 4}});
  EXPECT_NEAR(lead()->position.z(), 3 + WindowForces::kCarrySpeed * kStep, 1e-12);
  for (int i = 0; i < 1000; ++i) (void)lead();
  EXPECT_NEAR(lead()->position.z(), 4.0, 1e-12);
  hand.set_carry(std::nullopt);
  EXPECT_NEAR(lead()->position.z(), 4.0, 1e-12) << "it stays";
  // Snapshots know where it is.
  StateArchive writer = StateArchive::writer();
  hand.serialize(writer);
  const std::vector<std::byte> bytes = writer.take();
  WindowForces other(steered.scene, kStep);
  StateArchive reader = StateArchive::reader(bytes);
  other.serialize(reader);
  reader.end();
  scenes::StepCommands commands;
  commands.cloths.resize(1);
  commands.colliders.resize(1);
  commands.pushes.resize(1);
  other.steer(steered.state, kStep, commands);
  EXPECT_NEAR(commands.colliders[0]->position.z(), 4.0, 1e-12);
}

}  // namespace
}  // namespace weft::viewer
