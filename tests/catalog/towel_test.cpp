#include <string>

#include <gtest/gtest.h>

#include <weft/scenes/catalog.hpp>

#include "tests/catalog/scene_run.hpp"

namespace weft::scenes {
namespace {

class TowelScene : public testing::TestWithParam<const char*> {};

TEST_P(TowelScene, SlidesOffFoldsAndDoesNotPassThroughItself) {
  Scene scene = load_scene("towel");
  scene.engines = {GetParam()};
  scene.world.frame_interval = 0.1;  // [s]
  const RunNumbers numbers = measure_scene(scene);
  EXPECT_EQ(numbers.most_piercings, 0);
  EXPECT_LT(numbers.deepest, 0.002);  // a fifth of the margin; measured 0
  const Matrix3X<double>& x = numbers.end.at(0);
  EXPECT_LT(x.row(1).maxCoeff(), 0.3);  // off the rail, which is 0.64 m high
  EXPECT_LT(numbers.fastest_end, 0.2);  // [m/s] lies still; measured 0.02
  // Folded: a towel of 1 m covers less than 0.7 m of the floor.
  EXPECT_LT(x.row(2).maxCoeff() - x.row(2).minCoeff(), 0.7);
}

TEST_P(TowelScene, PassesThroughItselfWithoutSelfCollision) {
  Scene scene = load_scene("towel");
  scene.engines = {GetParam()};
  scene.world.frame_interval = 0.1;  // [s]
  scene.cloths[0].self_collision = false;
  scene.cloths[0].self_thickness.reset();
  EXPECT_GT(measure_scene(scene).most_piercings, 20);
}

INSTANTIATE_TEST_SUITE_P(Engines, TowelScene, testing::Values("bullet_soft", "bullet_weft"),
                         [](const auto& info) { return std::string(info.param); });

}  // namespace
}  // namespace weft::scenes
