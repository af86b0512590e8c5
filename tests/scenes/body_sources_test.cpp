#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <weft/core/input_file.hpp>
#include <weft/mesh/topology/hinges.hpp>
#include <weft/scenes/format/mesh_text.hpp>
#include <weft/scenes/format/scene_file.hpp>

namespace weft::scenes {
namespace {

using ::testing::ElementsAre;

constexpr std::string_view kHead = R"(schema = "weft-scene/1"
name = "bodies"
[world]
time_step = "1 ms"
duration = "1 s"
[[cloth]]
name = "body"
)";

constexpr std::string_view kBall = R"(
icosphere = { radius = "1/3 m", frequency = 2, center_node = true, center_mass_share = 0.25 }
center = ["1 m", "2 m", "3 m"]
orientation = { axis = [1, 1, 0], angle = "40 deg" }
areal_density = "1/7 kg/m^2"
mass_lumping = "uniform"
pin = [{ nodes = [3, "5-7", 6] },
       { nodes = [0], velocity = ["1 m/s", "0 m/s", "0 m/s"] }]
region = [{ name = "top", nodes = [{ sphere = { center = ["1 m", "7/3 m", "3 m"], radius = "20 cm" } }] }]
connection = [{ name = "ties", node = 4, to = [{ nodes = ["8-10"] }] }]
[[cloth.law]]
law = "pressure"
pressure = "1/3 kPa"
[[cloth.law]]
law = "tension"
edge_sets = ["center"]
stiffness = "3 N/m"
[[cloth.law]]
law = "nonlocal_torsion"
stiffness = "3 N*m/rad"
[[cloth.law]]
law = "drive"
stiffness = "3 N/m"
)";

constexpr std::string_view kRope = R"toml(
rope = { nodes = 11, start = ["0 m", "1 m", "0 m"], end = ["1/3 m", "1 m", "0 m"] }
linear_density = "30 g/m"
pin = [{ nodes = [0] }]
[[cloth.law]]
law = "tension"
stiffness = "30 N/m"
[[cloth.law]]
law = "torsion"
stiffness = "1/1000 N/(m*rad)"
)toml";

Scene read(std::string_view body) {
  return read_scene_text(std::string(kHead) + std::string(body), "body.toml");
}

TEST(BodySource, ASphereHasThePlaceMassAndCentreThatItsKeysSay) {
  const Cloth cloth = read(kBall).cloths.at(0);
  const ClothMesh mesh = make_mesh(cloth);
  ASSERT_EQ(mesh.num_nodes(), 43);
  EXPECT_EQ(num_nodes(cloth.source), 43);
  const Matrix3X<double> arms = mesh.rest_positions.colwise() - Vector3<double>(1, 2, 3);
  EXPECT_LE((arms.leftCols(42).colwise().norm().array() - 1.0 / 3.0).abs().maxCoeff(), 1e-15);
  EXPECT_LE(arms.col(42).norm(), 1e-15);
  EXPECT_TRUE(is_closed_surface(mesh.triangles));
  // 1e-14: the sum of 42 areas.
  const double mass = node_areas(mesh).sum() / 7;
  EXPECT_NEAR(mesh.masses.sum(), mass, 1e-14 * mass);
  EXPECT_NEAR(mesh.masses[42], mass / 4, 1e-14 * mass);
  EXPECT_EQ(mesh.masses[0], mesh.masses[1]);
  EXPECT_THAT(mesh.pinned, ElementsAre(0, 3, 5, 6, 7));
  EXPECT_EQ(mesh.pinned_velocity(0), Vector3<double>(1, 0, 0));
  EXPECT_EQ(cloth.laws.at(2).sets, (std::vector<std::string>{"center", "ties"}));
  ASSERT_FALSE(mesh.node_sets.at(0).nodes.empty());
  for (const int node : mesh.node_sets.at(0).nodes) EXPECT_GT(arms(1, node), 0.1);
}

TEST(BodySource, ARopeHasItsLengthTimesItsDensity) {
  const Cloth cloth = read(kRope).cloths.at(0);
  const ClothMesh mesh = make_mesh(cloth);
  EXPECT_EQ(num_nodes(cloth.source), 11);
  EXPECT_NEAR(mesh.masses.sum(), 0.01, 1e-16);
  EXPECT_EQ(cloth.laws.at(0).sets, (std::vector<std::string>{"stretch", "bend"}));
  EXPECT_EQ(cloth.laws.at(1).sets, (std::vector<std::string>{"lines"}));
  EXPECT_EQ(body_size(cloth.source), 1.0 / 3.0);
}

TEST(BodySource, WrittenReadsBackToTheSameTextAndTheSameBits) {
  for (const std::string_view body : {kBall, kRope}) {
    const Scene first = read(body);
    const std::string written = write_scene(first);
    const Scene second = read_scene_text(written, "written.toml");
    EXPECT_EQ(write_scene(second), written);
    const ClothMesh a = make_mesh(first.cloths[0]);
    const ClothMesh b = make_mesh(second.cloths[0]);
    EXPECT_EQ(a.rest_positions, b.rest_positions);
    EXPECT_EQ(a.masses, b.masses);
    EXPECT_EQ(a.pinned, b.pinned);
  }
}

TEST(BodySource, AMeshFileBesideTheSceneIsABodyThatItsTextTakesAlong) {
  const std::string name = std::string(WEFT_SOURCE_DIR) + "/tests/scenes/import/good/scene.toml";
  const auto read_mesh = [&](const std::string& file) {
    const std::string text = std::string(kHead) + "mesh = { file = \"" + file + R"(", scale = 0.1 }
position = ["1 m", "0 m", "0 m"]
orientation = { axis = [0, 0, 1], angle = "30 deg" }
areal_density = "1/3 kg/m^2"
pin = [{ part = "right" }]
)";
    return read_scene_text(text, name, files_below(std::filesystem::path(name).parent_path()));
  };
  const Scene first = read_mesh("two_parts.obj");
  const ClothMesh mesh = make_mesh(first.cloths[0]);
  EXPECT_EQ(mesh.num_nodes(), 9);
  EXPECT_THAT(mesh.pinned, ElementsAre(5, 6, 7, 8));
  EXPECT_EQ(mesh.rest_positions.col(0), Vector3<double>(1, 0, 0));
  // Two unit squares, a tenth in size. 1e-7: the file's positions are single precision.
  EXPECT_NEAR(mesh.masses.sum(), 0.02 / 3, 1e-7 * 0.02);
  // The written text names no file: it reads back where there is none.
  const std::string written = write_scene(first);
  const Scene second = read_scene_text(written, "elsewhere.toml");
  EXPECT_EQ(write_scene(second), written);
  EXPECT_EQ(make_mesh(second.cloths[0]).rest_positions, mesh.rest_positions);
  EXPECT_EQ(make_mesh(second.cloths[0]).masses, mesh.masses);
  EXPECT_EQ(make_mesh(second.cloths[0]).pinned, mesh.pinned);
  EXPECT_THROW((void)read_mesh("not_there.obj"), SceneError);
}

TEST(BodySource, AStoredMeshThatIsDamagedIsRefused) {
  const Surface surface =
      std::get<MeshBody>(
          read_scene_text(
              std::string(kHead) + "mesh = { file = \"tetrahedron.ply\" }\nmass = \"1 kg\"\n",
              "scene.toml", files_below(std::string(WEFT_SOURCE_DIR) + "/tests/scenes/import/good"))
              .cloths[0]
              .source)
          .shape->surface;
  const std::string text = mesh_text(surface);
  EXPECT_EQ(mesh_text(parse_mesh_text(text)), text);
  for (std::size_t size = 0; size < text.size(); ++size) {
    EXPECT_THROW((void)parse_mesh_text(text.substr(0, size)), InvalidArgument) << size;
  }
  EXPECT_THROW((void)parse_mesh_text("?" + text.substr(1)), InvalidArgument);
}

TEST(BodySource, CornersOfWhatIsNoGridAreRefusedAlsoFromCode) {
  Cloth cloth = read(kRope).cloths.at(0);
  cloth.pins = {CornerPin{}};
  EXPECT_THROW((void)make_mesh(cloth), InvalidArgument);
  cloth.pins = {EdgePin{}};
  EXPECT_THROW((void)make_mesh(cloth), InvalidArgument);
  cloth.pins = {NodePin{{11}}};
  EXPECT_THROW((void)make_mesh(cloth), InvalidArgument);
  EXPECT_THROW((void)cloth.grid(), InvalidArgument);
}

}  // namespace
}  // namespace weft::scenes
