#include <gtest/gtest.h>

#include <weft/scenes/catalog.hpp>

#include "tests/catalog/scene_run.hpp"

namespace weft::scenes {
namespace {

TEST(CurtainScene, NoNodeGoesBelowASurface) {
  const RunNumbers numbers = measure_scene(load_scene("curtain"));
  EXPECT_LT(numbers.deepest, 0.02);
}

}  // namespace
}  // namespace weft::scenes
