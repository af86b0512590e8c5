#include <gtest/gtest.h>

#include <weft/scenes/catalog.hpp>

#include "tests/catalog/scene_run.hpp"

namespace weft::scenes {
namespace {

TEST(CollidersScene, NoNodeGoesDeeperThanTheMargin) {
  Scene scene = load_scene("colliders");
  scene.world.duration = 1.0;  // [s]: all have landed after 0.4 s
  scene.world.frame_interval = scene.world.time_step;
  const RunNumbers numbers = measure_scene(scene);
  // Deepest at the tip of the cone, between four nodes: 14.5 mm.
  EXPECT_LT(numbers.deepest, scene.cloths[0].collision_margin);
}

TEST(CollidersScene, HasEveryKindOfObstacle) {
  const Scene scene = load_scene("colliders");
  std::vector<bool> seen(std::variant_size_v<Shape>, false);
  bool is_led = false;
  bool is_free = false;
  for (const Collider& collider : scene.colliders) {
    seen[collider.shape.index()] = true;
    is_led = is_led || collider.path.has_value();
    is_free = is_free || collider.mass.has_value();
  }
  for (std::size_t kind = 0; kind < seen.size(); ++kind) EXPECT_TRUE(seen[kind]) << kind;
  EXPECT_TRUE(is_led);
  EXPECT_TRUE(is_free);
}

}  // namespace
}  // namespace weft::scenes
