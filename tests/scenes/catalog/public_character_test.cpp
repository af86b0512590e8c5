// A public rigged model with a cape: it runs as it comes from the net, and the cape follows its chest.
#include <gtest/gtest.h>

#include <weft/scenes/catalog.hpp>
#include <weft/scenes/characters/character_controller.hpp>
#include <weft/scenes/controllers/pin_path.hpp>

#include "tests/scenes/catalog/scene_run.hpp"

namespace weft::scenes {
namespace {

class PublicCharacter : public testing::TestWithParam<const char*> {};

TEST_P(PublicCharacter, WearsACapeThatItsChestLeads) {
  Scene scene = load_scene(WEFT_TEST_FOLDER "/characters/robot_cape.toml");
  scene.engines = {GetParam()};
  scene.world.duration = 1.5;
  ASSERT_EQ(scene.cloths[0].name, "cape");
  ASSERT_GE(scene.characters[0].skins.size(), 10U);  // the parts of the robot
  const ClothMesh mesh = make_mesh(scene.cloths[0]);
  const CharacterSettings& robot = scene.characters[0];
  const CharacterCollider& chest = robot.colliders[0];
  const auto bone =
      static_cast<std::size_t>(find_bone(robot.model->character.skeleton, chest.bone));
  const auto chest_pose = [&](double time) {
    return led_pose(world_frames(*robot.model, robot.pose, time)[bone], chest.place);
  };
  const Pose start = chest_pose(0.0);
  double worst = 0;   // [m] of a pinned node from its place at the chest
  double turned = 0;  // [m] that the chest carries a pinned node
  double swing = 0;   // [m] that a node of the hem is away from where the chest would have it
  run_scene(scene, [&](const SceneState& state) {
    const Pose now = chest_pose(state.time);
    const auto place = [&](int node) { return carried(start, now, mesh.rest_positions.col(node)); };
    for (const int node : mesh.pinned) {
      worst = std::max(worst, (state.cloths[0].positions.col(node) - place(node)).norm());
      turned = std::max(turned, (place(node) - mesh.rest_positions.col(node)).norm());
    }
    const int hem = mesh.num_nodes() - 1;
    swing = std::max(swing, (state.cloths[0].positions.col(hem) - place(hem)).norm());
  });
  EXPECT_LT(worst, 3e-7);  // a place some 1 m from the origin in single precision
  EXPECT_GT(turned, 0.01);
  EXPECT_GT(swing, 0.05);
  EXPECT_LT(swing, 1.2);  // twice its length: it has not flown off
}

INSTANTIATE_TEST_SUITE_P(Bullet, PublicCharacter,
                         testing::Values("bullet_soft", "bullet_forces", "bullet_weft"),
                         [](const auto& info) { return std::string(info.param); });

}  // namespace
}  // namespace weft::scenes
