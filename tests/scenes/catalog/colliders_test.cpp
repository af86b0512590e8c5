#include <string>

#include <gtest/gtest.h>

#include <weft/scenes/catalog.hpp>
#include <weft/validation/metrics/distance/penetration.hpp>

#include "tests/scenes/catalog/scene_run.hpp"

namespace weft::scenes {
namespace {

class CollidersScene : public testing::TestWithParam<const char*> {};

/// Share of its margin that a node may go below a surface: a fixed or led surface is never reached.
/// A free body is struck by the cloth and moves against it within the same step: measured 1.35.
constexpr double kShareOfMargin = 1.0;
constexpr double kShareOfMarginFree = 1.6;

TEST_P(CollidersScene, NoNodeGoesDeeperThanTheMargin) {
  Scene scene = load_scene("colliders");
  scene.engines = {GetParam()};
  scene.world.duration = 1.0;  // [s]: all have landed after 0.4 s
  scene.world.frame_interval = 2 * scene.world.time_step;
  run_scene(scene, [&](const SceneState& state) {
    const std::vector<validation::Penetration> rows = validation::penetrations(scene, state);
    for (std::size_t r = 0; r < rows.size(); ++r) {
      const Cloth& cloth = scene.cloths[r / scene.colliders.size()];
      const Collider& collider = scene.colliders[r % scene.colliders.size()];
      const double share = collider.mass ? kShareOfMarginFree : kShareOfMargin;
      ASSERT_LT(rows[r].surface.deepest, share * cloth.collision_margin)
          << cloth.name << " in " << collider.name << " at " << state.time << " s";
    }
  });
}

TEST(CollidersSceneFile, HasEveryKindOfObstacle) {
  const Scene scene = load_scene("colliders");
  std::vector<bool> seen(std::variant_size_v<Shape>, false);
  bool is_kinematic = false;
  bool is_free = false;
  for (const Collider& collider : scene.colliders) {
    seen[collider.shape.index()] = true;
    is_kinematic = is_kinematic || collider.path.has_value();
    is_free = is_free || collider.mass.has_value();
  }
  for (std::size_t kind = 0; kind < seen.size(); ++kind) EXPECT_TRUE(seen[kind]) << kind;
  EXPECT_TRUE(is_kinematic);
  EXPECT_TRUE(is_free);
}

INSTANTIATE_TEST_SUITE_P(Engines, CollidersScene, testing::Values("bullet_soft", "bullet_weft"),
                         [](const auto& info) { return std::string(info.param); });

}  // namespace
}  // namespace weft::scenes
