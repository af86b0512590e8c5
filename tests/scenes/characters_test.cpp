#include <fstream>
#include <limits>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <weft/scenes/catalog.hpp>
#include <weft/scenes/characters/character_settings.hpp>
#include <weft/scenes/characters/start_state.hpp>
#include <weft/scenes/format/scene_file.hpp>

namespace weft::scenes {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

const std::string kStart = R"(schema = "weft-scene/1"
name = "figure"

[world]
time_step = "1/1000 s"
duration = "1 s"

[[character]]
name = "figure"
)";

const std::string kCharacter = kStart + R"(file = "caped_figure.glb"
clip = "Walk"
)";

const std::string kCape = kCharacter + R"(
[[character.cloth]]
part = "Cape"
mass = "200 g"
)";

std::string message_of(const std::string& text) {
  try {
    (void)read_scene_text(text, "figure.toml");
  } catch (const SceneError& error) {
    return error.what();
  }
  return "no error";
}

TEST(Characters, WhatTheModelDoesNotHaveIsAnErrorThatListsWhatItHas) {
  EXPECT_EQ(
      message_of(kStart + "file = \"caped_figure.glb\"\nclip = \"Run\"\n"),
      "figure.toml:11:8: character.clip = \"Run\": unknown clip 'Run', expected one of 'Walk'");
  EXPECT_THAT(message_of(kCharacter + "[[character.cloth]]\npart = \"Skirt\"\n"),
              HasSubstr("unknown part 'Skirt', expected one of 'Body', 'Cape', 'CapeFine'"));
  EXPECT_THAT(message_of(kCharacter + "[[character.collider]]\nname = \"tail\"\nbone = \"Tail\"\n"),
              HasSubstr("unknown bone 'Tail', expected one of 'Rig', "));
  EXPECT_THAT(message_of(kCape + "paint = { group = \"Tail\" }\n"),
              HasSubstr("unknown vertex group 'Tail', expected one of "));
}

TEST(Characters, MistakesOfTheSceneAreErrorsWithTheirPlace) {
  EXPECT_THAT(message_of(kStart + "file = \"no.glb\"\n"),
              StartsWith("figure.toml:10:8: character.file = \"no.glb\": no such file"));
  EXPECT_THAT(message_of(kStart + "file = \"data:model/gltf-binary;base64,???\"\n"),
              HasSubstr("is no base64 text"));
  EXPECT_THAT(message_of(kStart + "file = \"data:model/gltf-binary;base64,AAAA\"\n"),
              HasSubstr("is no glTF file"));
  EXPECT_THAT(message_of(kCharacter + "scale = 0\n"), HasSubstr("character.scale = 0"));
  EXPECT_THAT(message_of(kCharacter + "[[character.cloth]]\npart = \"Cape\"\n"),
              HasSubstr("missing key 'mass' or 'areal_density'"));
  EXPECT_THAT(message_of(kCape + "max_distance = \"-1 cm\"\n"), HasSubstr("max_distance"));
  EXPECT_THAT(message_of(kCape + "backstop_offset = \"1 cm\"\n"),
              HasSubstr("expected a backstop_radius as well"));
  EXPECT_THAT(message_of(kCape + "paint = { color = \"pink\" }\n"),
              HasSubstr("unknown colour channel"));
  EXPECT_THAT(message_of(kCape + "paint = {}\n"),
              HasSubstr("expected exactly one of color, group"));
  EXPECT_THAT(message_of(kCape + "[[character.cloth]]\npart = \"Cape\"\nmass = \"1 kg\"\n"),
              HasSubstr("is a cloth already"));
  EXPECT_THAT(message_of(kCharacter + "[[character.cloth]]\npart = \"Body\"\nmass = \"1 kg\"\n"
                                      "paint = { color = \"red\" }\n"),
              HasSubstr("has no vertex colours"));
  EXPECT_THAT(message_of(kCharacter + "[[character.collider]]\nname = \"a\"\nbone = \"Head\"\n"
                                      "shape = \"sphere\"\nradius = \"1 cm\"\nmass = \"1 kg\"\n"),
              HasSubstr("a bone leads the collider"));
  EXPECT_THAT(
      message_of(kCape + "[[cloth]]\nname = \"figure-Cape\"\nmass = \"1 kg\"\ngrid = { nodes = "
                         "[3, 3], size = [\"1 m\", \"1 m\"] }\n"),
      HasSubstr("another body has this name"));
}

TEST(Characters, AreBodiesOfTheScene) {
  const Scene scene = load_scene("caped_figure");
  ASSERT_EQ(scene.cloths.size(), 2U);
  EXPECT_EQ(scene.cloths[0].name, "cape");
  EXPECT_EQ(scene.cloths[1].name, "figure-Body-skin");
  EXPECT_TRUE(scene.cloths[1].laws.empty());
  // The two rows at the collar are painted black.
  EXPECT_EQ(make_mesh(scene.cloths[0]).pinned.size(), 50U);
  EXPECT_EQ(make_mesh(scene.cloths[1]).pinned.size(),
            static_cast<std::size_t>(make_mesh(scene.cloths[1]).num_nodes()));
  EXPECT_EQ(scene.colliders[0].led_by, "figure");
}

TEST(Characters, PaintIsAShareOfTheMaximumDistance) {
  const Scene scene = load_scene("caped_figure");
  const auto& source = std::get<SkinSource>(scene.cloths[0].source);
  ReachSettings reach = scene.characters[0].cloths[0].reach;
  const VectorX<double> distances = max_distances(reach, source);
  EXPECT_EQ(distances.minCoeff(), 0.0);
  EXPECT_NEAR(distances.maxCoeff(), 0.4, 1e-6);
  reach.max_distance.reset();
  const VectorX<double> attached = max_distances(reach, source);
  EXPECT_EQ(attached.minCoeff(), 0.0);
  EXPECT_EQ(attached.maxCoeff(), std::numeric_limits<double>::infinity());
}

TEST(Characters, StartInTheFirstPoseOfTheClip) {
  const Scene scene = load_scene("caped_figure");
  for (const Cloth& cloth : scene.cloths) {
    const auto& source = std::get<SkinSource>(cloth.source);
    const StartState start = start_state(cloth, make_mesh(cloth));
    EXPECT_EQ(start.positions, skin_positions(source, 0.0));
    EXPECT_LT(start.velocities.cwiseAbs().maxCoeff(), 3.0);
  }
  // The first pose is no rest pose: the hips are lower and the arms swing.
  const auto& body = std::get<SkinSource>(scene.cloths[1].source);
  EXPECT_GT((skin_positions(body, 0.0) - rest_positions(body)).cwiseAbs().maxCoeff(), 0.02);
}

TEST(Characters, ARecordedSceneNeedsNoModelFile) {
  const std::string written = write_scene(load_scene("caped_figure"));
  EXPECT_EQ(written.find("caped_figure.glb"), std::string::npos);
  const Scene back = read_scene_text(written, "/nowhere/written.toml");
  EXPECT_EQ(write_scene(back), written);
  EXPECT_EQ(make_mesh(back.cloths[0]).rest_positions,
            make_mesh(load_scene("caped_figure").cloths[0]).rest_positions);
}

}  // namespace
}  // namespace weft::scenes
