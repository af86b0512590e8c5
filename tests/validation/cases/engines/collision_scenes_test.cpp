#include <weft/validation/cases/engines/collision_scenes.hpp>

#include <set>
#include <string>

#include <gtest/gtest.h>

namespace weft::validation {
namespace {

TEST(CollisionScenes, AreTenBodiesAndTwoThatSlideEachWithItsOwnName) {
  std::set<std::string> ids;
  int sliding = 0;
  for (const CollisionScene& scene : collision_scenes()) {
    ids.insert(scene.id);
    if (scene.slides) ++sliding;
  }
  EXPECT_EQ(ids.size(), 12U);
  EXPECT_EQ(sliding, 2);
}

TEST(CollisionScenes, AreTheSameClothInEveryResolution) {
  for (const CollisionScene& row : collision_scenes()) {
    const scenes::Scene coarse = make_collision_scene(row, 12);
    const scenes::Scene fine = make_collision_scene(row, 26);
    EXPECT_EQ(scenes::make_mesh(coarse.cloths[0]).rest_positions.cols(), 144) << row.id;
    EXPECT_EQ(scenes::make_mesh(fine.cloths[0]).rest_positions.cols(), 676) << row.id;
    EXPECT_EQ(coarse.world.time_step, fine.world.time_step) << row.id;
    EXPECT_NEAR(coarse.cloths[0].grid().total_mass, fine.cloths[0].grid().total_mass, 1e-12)
        << row.id;
  }
}

TEST(CollisionScenes, HaveAMistakeThatChangesThem) {
  for (const CollisionScene& row : collision_scenes()) {
    for (const Sabotage& sabotage : {row.early(), row.late()}) {
      const scenes::Scene right = make_collision_scene(row, 12);
      scenes::Scene wrong = right;
      sabotage.edit_scene(wrong);
      const bool differs =
          wrong.colliders[0].position != right.colliders[0].position ||
          wrong.colliders[0].path.has_value() != right.colliders[0].path.has_value() ||
          wrong.cloths[0].friction != right.cloths[0].friction;
      EXPECT_TRUE(differs) << row.id << ": " << sabotage.name;
    }
  }
}

TEST(CollisionScenes, LeaveRoomForThreeStepsOfTheReference) {
  for (const CollisionScene& row : collision_scenes()) {
    EXPECT_GE(row.finest_division, 4) << row.id;
    EXPECT_EQ(row.finest_division % 4, 0) << row.id;
  }
}

}  // namespace
}  // namespace weft::validation
