#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <limits>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <weft/core/error.hpp>
#include <weft/scenes/catalog.hpp>
#include <weft/scenes/format/mesh_text.hpp>
#include <weft/scenes/format/scene_file.hpp>

namespace weft::scenes {
namespace {

using ::testing::HasSubstr;

const std::string kClothStart = R"(schema = "weft-scene/1"
name = "drawn"
[world]
time_step = "1 ms"
duration = "1 s"
[[cloth]]
name = "sheet"
mass = "200 g"
)";

const std::string kGrid = "grid = { nodes = [5, 5], size = [\"2 m\", \"2 m\"] }\n";

const std::string kCapedStart = R"(schema = "weft-scene/1"
name = "drawn"
[world]
time_step = "1 ms"
duration = "1 s"
[[character]]
name = "figure"
file = "caped_figure.glb"
[[character.cloth]]
part = "Cape"
mass = "200 g"
)";

/// Files of this test: a square of two triangles, 1 m x 1 m in the plane z = 0, and some that are none.
std::string read_drawn(const std::string& name) {
  if (name == "square.obj") {
    return "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n";
  }
  if (name == "flat.obj") return "v 0 0 0\nv 1 0 0\nv 0 0 1\nf 1 3 2\n";
  // Three triangles at one edge, one of them turned: no body, but it can be drawn.
  if (name == "book.obj") {
    return "v 0 0 0\nv 1 0 0\nv 0 0 1\nv 0 0 -1\nv 0 0.01 0.5\nf 1 3 2\nf 1 2 4\nf 1 2 5\n";
  }
  if (name == "points.obj") return "v 0 0 0\nv 1 0 0\nv 0 0 1\n";
  return "";
}

class DrawnMeshFile : public testing::Test {
 protected:
  DrawnMeshFile()
      : folder_(std::filesystem::temp_directory_path() /
                ("weft_drawn_mesh_" + std::to_string(getpid()))) {
    std::filesystem::create_directories(folder_);
    for (const char* name : {"square.obj", "flat.obj", "book.obj", "points.obj"}) {
      write(name, read_drawn(name));
    }
  }
  ~DrawnMeshFile() override { std::filesystem::remove_all(folder_); }

  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }
  [[nodiscard]] Scene read(const std::string& text) const {
    write("scene.toml", text);
    return read_scene_file(folder_ / "scene.toml");
  }
  [[nodiscard]] std::string fault(const std::string& text) const {
    try {
      (void)read(text);
    } catch (const Error& error) {
      return error.what();
    }
    return "no error";
  }

 private:
  std::filesystem::path folder_;
};

TEST_F(DrawnMeshFile, LiesInTheWorldOrInTheFrameOfTheBodysOwnFile) {
  const Scene in_world =
      read(kClothStart + kGrid + "drawn_mesh = { file = \"flat.obj\", scale = 0.5 }\n");
  const Surface& flat = *in_world.cloths[0].drawn_mesh.value().surface;
  EXPECT_EQ(Vector3<double>(flat.positions.col(2)), Vector3<double>(0.5, 0, 0));
  const Scene placed =
      read(kClothStart +
           "mesh = { file = \"square.obj\" }\nposition = [\"0 m\", \"0 m\", \"3 m\"]\n"
           "drawn_mesh = { file = \"square.obj\" }\n");
  EXPECT_EQ(placed.cloths[0].drawn_mesh.value().surface->positions,
            make_mesh(placed.cloths[0]).rest_positions);
}

TEST_F(DrawnMeshFile, ARecordedSceneHoldsTheMeshAndReadsBackToTheSameBits) {
  const std::string written = write_scene(read(
      kClothStart + kGrid +
      "drawn_mesh = { file = \"book.obj\", max_distance = \"1/3 m\", rigid_pieces = \"3 cm\" }\n"));
  EXPECT_EQ(written.find("book.obj"), std::string::npos);
  const Scene back = read_scene_text(written, "/nowhere/written.toml");
  EXPECT_EQ(write_scene(back), written);
  const DrawnCloth& drawn = back.cloths[0].drawn_mesh.value();
  EXPECT_EQ(drawn.surface->triangles.cols(), 3);
  EXPECT_EQ(drawn.embedding.max_distance, 1.0 / 3);
  EXPECT_EQ(drawn.embedding.rigid_pieces, 0.03);
}

TEST_F(DrawnMeshFile, MistakesAreErrorsWithTheirPlace) {
  const auto with = [&](const std::string& table) {
    return fault(kClothStart + kGrid + "drawn_mesh = " + table + "\n");
  };
  EXPECT_THAT(with("{ file = \"none.obj\" }"),
              HasSubstr("10:23: cloth.drawn_mesh.file = \"none.obj\""));
  EXPECT_THAT(with("{ file = \"points.obj\" }"), HasSubstr("has no triangle"));
  EXPECT_THAT(
      with("{ file = \"square.obj\", max_distance = \"10 cm\" }"),
      HasSubstr(
          "10:14: cloth.drawn_mesh = {...}: embedding: vertex 2 of the drawn mesh is 1.000000 m "
          "from the cloth, expected at most 0.100000 m (2 vertices are farther)"));
  EXPECT_THAT(with("{ file = \"flat.obj\", max_distance = \"0 m\" }"), HasSubstr("max_distance"));
  EXPECT_THAT(with("{ file = \"flat.obj\", rigid_pieces = 3 }"), HasSubstr("rigid_pieces"));
  EXPECT_THAT(with("{ file = \"flat.obj\", thickness = \"1 cm\" }"), HasSubstr("unknown key"));
  EXPECT_THAT(with("{}"), HasSubstr("missing key 'file'"));
  EXPECT_THAT(with("\"flat.obj\""), HasSubstr("expected a table"));
  EXPECT_THAT(with("{ data = \"AAAA\" }"), HasSubstr("cloth.drawn_mesh.data"));
  EXPECT_THAT(fault("schema = \"weft-scene/1\"\nname = \"drawn\"\n[world]\ntime_step = \"1 "
                    "ms\"\nduration = \"1 s\"\n"
                    "[[cloth]]\nname = \"line\"\nmass = \"1 g\"\n"
                    "rope = { nodes = 3, start = [\"0 m\", \"0 m\", \"0 m\"], end = [\"1 m\", \"0 "
                    "m\", \"0 m\"] }\n"
                    "drawn_mesh = { file = \"flat.obj\" }\n"),
              HasSubstr("the cloth has no triangle, expected a surface"));
}

std::string fault_of_part(const std::string& table) {
  try {
    (void)read_scene_text(kCapedStart + "drawn_mesh = " + table + "\n", "figure.toml");
  } catch (const SceneError& error) {
    return error.what();
  }
  return "no error";
}

TEST(DrawnMeshText, TextureCoordinatesMustFitAndBeNumbers) {
  Surface surface;
  surface.positions.resize(3, 3);
  surface.positions << 0, 1, 0, 0, 0, 0, 0, 0, 1;
  surface.triangles.resize(3, 1);
  surface.triangles << 0, 2, 1;
  const auto fault_of = [&] {
    try {
      (void)read_scene_text(
          kClothStart + kGrid + "drawn_mesh = { data = \"" + mesh_text(surface) + "\" }\n",
          "a.toml");
    } catch (const SceneError& error) {
      return std::string(error.what());
    }
    return std::string("no error");
  };
  EXPECT_EQ(fault_of(), "no error");
  surface.corner_texture_coordinates = Matrix2X<double>::Zero(2, 2);
  EXPECT_THAT(fault_of(), HasSubstr("cloth.drawn_mesh = {...}: "));
  surface.corner_texture_coordinates =
      Matrix2X<double>::Constant(2, 3, std::numeric_limits<double>::quiet_NaN());
  EXPECT_THAT(fault_of(), HasSubstr("a texture coordinate is not finite"));
}

TEST(DrawnPart, IsNoSkinAndLiesAroundItsCloth) {
  const Scene scene =
      read_scene_text(kCapedStart + "drawn_mesh = { part = \"CapeFine\" }\n", "figure.toml");
  ASSERT_EQ(scene.cloths.size(), 2U);
  const DrawnCloth& drawn = scene.cloths[0].drawn_mesh.value();
  EXPECT_EQ(drawn.part, "CapeFine");
  EXPECT_GT(drawn.surface->triangles.cols(), 9000);
  const ClothMesh mesh = make_mesh(scene.cloths[0]);
  const ClothEmbedding embedding(mesh.rest_positions, mesh.triangles,
                                 {drawn.surface->positions, drawn.surface->triangles});
  EXPECT_LT(embedding.report().largest_distance, 0.03);
  // Without the key the part is a skin as any other.
  EXPECT_EQ(read_scene_text(kCapedStart, "figure.toml").cloths.size(), 3U);
}

TEST(DrawnPart, ARecordedSceneNamesThePart) {
  const std::string written = write_scene(load_scene("caped_figure"));
  EXPECT_THAT(written, HasSubstr("drawn_mesh = { part = \"CapeFine\""));
  EXPECT_EQ(write_scene(read_scene_text(written, "/nowhere/written.toml")), written);
}

TEST(DrawnPart, MistakesAreErrors) {
  EXPECT_THAT(fault_of_part("{ part = \"Skirt\" }"),
              HasSubstr("unknown part 'Skirt', expected one of 'Body', 'Cape', 'CapeFine'"));
  EXPECT_THAT(fault_of_part("{ part = \"Cape\" }"), HasSubstr("is a cloth already"));
  EXPECT_THAT(fault_of_part("{ part = \"Body\", max_distance = \"5 cm\" }"),
              HasSubstr("from the cloth, expected at most 0.050000 m"));
  EXPECT_THAT(fault_of_part("{ file = \"cape.obj\" }"), HasSubstr("unknown key"));
}

}  // namespace
}  // namespace weft::scenes
