#include <gtest/gtest.h>

#include <weft/scenes/catalog.hpp>

#include "tests/catalog/scene_run.hpp"

namespace weft::scenes {
namespace {

/// With the engine bullet_weft, and a picture each tenth of a second.
Scene fast_scene(const std::string& name) {
  Scene scene = load_scene(name);
  scene.engines = {"bullet_weft"};
  scene.world.frame_interval = 0.1;  // [s]
  return scene;
}

TEST(FastEngine, TowelDoesNotPassThroughItself) {
  const Scene scene = fast_scene("towel");
  const RunNumbers numbers = measure_scene(scene);
  RecordProperty("most_piercings", numbers.most_piercings);
  EXPECT_EQ(numbers.piercings_end, 0);
  EXPECT_LT(numbers.deepest, 0.002);  // a fifth of the margin
  EXPECT_LT(numbers.fastest_end, 0.2);
}

TEST(FastEngine, TowelPassesThroughItselfWithoutSelfCollision) {
  Scene scene = fast_scene("towel");
  scene.cloths[0].self_collision = false;
  scene.cloths[0].self_thickness.reset();
  EXPECT_GT(measure_scene(scene).most_piercings, 20);
}

TEST(FastEngine, StackLiesInLayers) {
  Scene scene = fast_scene("stack");
  scene.world.duration = 1.0;  // [s]
  const RunNumbers numbers = measure_scene(scene);
  RecordProperty("most_piercings", numbers.most_piercings);
  EXPECT_EQ(numbers.piercings_end, 0);
  EXPECT_LT(numbers.deepest, scene.cloths[0].collision_margin);
}

}  // namespace
}  // namespace weft::scenes
