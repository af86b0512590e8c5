#include <string>

#include <gtest/gtest.h>

#include <weft/scenes/catalog.hpp>

#include "tests/scenes/catalog/scene_run.hpp"

namespace weft::scenes {
namespace {

class CurtainScene : public testing::TestWithParam<const char*> {};

TEST_P(CurtainScene, IsDrawnTogetherAndFolds) {
  Scene scene = load_scene("curtain");
  scene.engines = {GetParam()};
  scene.world.duration = 2.3;  // [s]: drawn together
  scene.world.frame_interval = 0.1;
  const RunNumbers numbers = measure_scene(scene);
  EXPECT_EQ(numbers.most_piercings, 0);
  EXPECT_LT(numbers.deepest, 0.002);
  const Matrix3X<double>& x = numbers.end.at(0);
  // The upper edge of 2 m is held over 45 % of that; the rest goes into folds.
  EXPECT_NEAR(x(0, 40) - x(0, 0), 0.9, 0.01);
  EXPECT_GT(x.row(2).maxCoeff() - x.row(2).minCoeff(), 0.1);
}

INSTANTIATE_TEST_SUITE_P(Engines, CurtainScene, testing::Values("bullet_soft", "bullet_weft"),
                         [](const auto& info) { return std::string(info.param); });

}  // namespace
}  // namespace weft::scenes
