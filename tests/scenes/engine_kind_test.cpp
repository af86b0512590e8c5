#include <weft/scenes/engine_kind.hpp>

#include <fstream>
#include <iterator>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <weft/scenes/format/scene_words.hpp>
#include <weft/scenes/scene.hpp>

namespace weft::scenes {
namespace {

using testing::HasSubstr;

std::string page(const std::string& path) {
  std::ifstream file(WEFT_SOURCE_DIR "/" + path);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST(EngineKinds, AreFoundByName) {
  for (const EngineKind& kind : kEngineKinds)
    EXPECT_EQ(find_engine_kind(kind.name)->name, kind.name);
  EXPECT_EQ(find_engine_kind("bullet"), nullptr);
}

TEST(EngineKinds, EachIsExplainedInTheReadme) {
  const std::string readme = page("README.md");
  for (const EngineKind& kind : kEngineKinds) {
    EXPECT_THAT(readme, HasSubstr("| `" + std::string(kind.name) + "` |"));
  }
}

TEST(EngineKinds, AreTheEnginesOfTheSceneFormat) {
  const std::string formats = page("docs/scene_format.md");
  for (const EngineKind& kind : kEngineKinds) {
    EXPECT_THAT(formats, HasSubstr('"' + std::string(kind.name) + '"'));
  }
}

TEST(Integrators, AreAllOnTheFormatsPage) {
  const std::string formats = page("docs/scene_format.md");
  for (const std::string_view word : kIntegratorWords) {
    EXPECT_THAT(formats, HasSubstr('"' + std::string(word) + '"'));
  }
}

TEST(EngineKinds, TheImplicitOneHasAStepOfItsOwn) {
  Scene scene;
  scene.world.time_step = 1.0 / 600;
  scene.world.implicit_time_step = 1.0 / 60;
  for (const EngineKind& kind : kEngineKinds) {
    EXPECT_EQ(with_step_of(scene, kind.name).world.time_step,
              kind.is_implicit ? 1.0 / 60 : 1.0 / 600)
        << kind.name;
  }
}

}  // namespace
}  // namespace weft::scenes
