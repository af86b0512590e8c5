#include <weft/scenes/page/drawn_scene.hpp>

#include <gtest/gtest.h>

#include <weft/scenes/catalog.hpp>
#include <weft/scenes/scene_file.hpp>

namespace weft::scenes {
namespace {

TEST(DrawnScene, HasMeshesInPlaceOfACharacter) {
  const Scene scene = load_scene("caped_figure");
  const Scene drawn = drawn_scene(scene);
  ASSERT_EQ(drawn.cloths.size(), scene.cloths.size());
  EXPECT_TRUE(drawn.characters.empty());
  int num_skins = 0;
  for (std::size_t c = 0; c < scene.cloths.size(); ++c) {
    num_skins += std::holds_alternative<SkinSource>(scene.cloths[c].source) ? 1 : 0;
    EXPECT_FALSE(std::holds_alternative<SkinSource>(drawn.cloths[c].source));
    const ClothMesh before = make_source_mesh(scene.cloths[c].source);
    const auto* body = std::get_if<MeshBody>(&drawn.cloths[c].source);
    if (body == nullptr) continue;
    EXPECT_EQ(body->shape->surface.triangles, before.triangles);
    EXPECT_EQ(body->shape->surface.positions, before.rest_positions);
  }
  EXPECT_GT(num_skins, 0) << "a scene without a character says nothing here";
  EXPECT_EQ(write_scene(drawn).find("[[character"), std::string::npos);
}

TEST(DrawnScene, WithoutCharactersDrawsTheSame) {
  const Scene scene = load_scene("hang");
  EXPECT_EQ(write_scene(drawn_scene(scene)), write_scene(scene));
}

}  // namespace
}  // namespace weft::scenes
