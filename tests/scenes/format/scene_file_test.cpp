#include <weft/scenes/format/scene_file.hpp>

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <weft/scenes/format/text_guard.hpp>
#include "tests/scenes/malformed_cases.hpp"

namespace weft::scenes {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

const std::filesystem::path kMalformed = std::string(WEFT_SOURCE_DIR) + "/tests/scenes/malformed";

// Every optional key is given, with values that no default has.
constexpr std::string_view kFullScene = R"(schema = "weft-scene/1"
name = "full"
summary = "Shows \"quotes\" and a \\ in a text"
[world]
gravity = ["0.1 m/s^2", "-1/3 m/s^2", "0 m/s^2"]
time_step = "1/300 s"
duration = "1/3 s"
frame_interval = "1/30 s"
[[cloth]]
name = "sheet-1"
grid = { nodes = [5, 4], size = ["70 cm", "1/3 m"], stencil = "12-neighbor" }
center = ["1 mm", "2 cm", "3 dm"]
u_axis = [0.6, 0.0, 0.8]
v_axis = [-0.8, 0, 0.6]
areal_density = "120 g/m^2"
mass_lumping = "uniform"
velocity = ["1 m/s", "2 m/s", "3 m/s"]
collision_margin = "3 mm"
friction = 0.25
pin = [{ corner = "-u-v" }, { corner = "+u-v" }, { corner = "-u+v" }, { corner = "+u+v" }, { edge = "-u" },
       { edge = "+u" }, { edge = "-v" }, { edge = "+v" },
       { box = { min = ["-9 m", "-9 m", "-9 m"], max = ["9 m", "9 m", "9 m"] } },
       { edge = "-u", velocity = ["1/3 m/s", "0 m/s", "-2 m/s"] }]
region = [{ name = "hand", nodes = [{ edge = "+v" }] }, { name = "foot", nodes = [{ corner = "-u-v" }] }]
[[cloth.law]]
law = "gravity"
[[cloth.law]]
law = "drive"
node_sets = ["hand"]
stiffness = "1/7 kN/m"
angular_velocity = ["0 rad/s", "90 deg/s", "0 rad/s"]
[[cloth.law]]
law = "tension"
stiffness = "1/7 kN/m"
[[cloth]]
name = "sheet-2"
grid = { nodes = [2, 2], size = ["1 m", "1 m"], stencil = "8-neighbour" }
mass = "1/3 kg"
[[cloth.law]]
law = "gravity"
acceleration = ["0 m/s^2", "1 m/s^2", "2 m/s^2"]
[[collider]]
name = "ball"
shape = "sphere"
radius = "1/3 m"
position = ["1/7 m", "0 m", "0 m"]
orientation = { axis = [1, 2, 3], angle = "33 deg" }
friction = 0.7
mass = "1/9 kg"
velocity = ["1/7 m/s", "0 m/s", "0 m/s"]
angular_velocity = ["10 deg/s", "0 rad/s", "0 rad/s"]
[[collider]]
name = "crate"
shape = "box"
size = ["1/3 m", "2 m", "3 m"]
orientation = { quaternion = [1, 2, 3, 4] }
[[collider]]
name = "floor"
shape = "plane"
[bullet]
position_iterations = 7
[reference]
integrator = "tr_bdf2"
tolerance = 1e-8
spectral_radius = 0.25
contact = "projection"
contact_points = "nodes_and_faces"
step_guard = "substep"
[camera]
position = ["1 m", "2 m", "3 m"]
target = ["1/3 m", "0 m", "0 m"]
field_of_view = "41 deg"
)";

constexpr std::string_view kSmallScene = R"(schema = "weft-scene/1"
name = "small"
[world]
time_step = "1/100 s"
duration = "1 s"
[[cloth]]
name = "cloth"
grid = { nodes = [3, 3], size = ["1 m", "1 m"] }
mass = "1 kg"
)";

SceneError error_of(std::string_view text) {
  try {
    (void)read_scene_text(text, "test.toml");
  } catch (const SceneError& error) {
    return error;
  }
  return {"no error", 0, 0, ""};
}

SceneError file_error_of(const std::filesystem::path& path) {
  try {
    (void)read_scene_file(path);
  } catch (const SceneError& error) {
    return error;
  }
  return {"no error", 0, 0, ""};
}

TEST(SceneFile, EveryMalformedFileNamesPlaceAndExpectation) {
  for (const MalformedCase& c : kMalformedCases) {
    const std::filesystem::path path = kMalformed / (std::string(c.name) + ".toml");
    const SceneError error = file_error_of(path);
    EXPECT_EQ(error.line(), c.line) << error.what();
    EXPECT_EQ(error.column(), c.column) << error.what();
    EXPECT_THAT(error.what(), HasSubstr(std::string(c.fragment)));
    const std::string place = ":" + std::to_string(c.line) + ":" + std::to_string(c.column) + ": ";
    EXPECT_THAT(error.what(), StartsWith(path.string() + place));
    EXPECT_EQ(std::string_view(error.what()).find('\n'), std::string_view::npos) << error.what();
  }
}

TEST(SceneFile, EveryMalformedFileIsInTheTable) {
  std::set<std::string> listed;
  for (const MalformedCase& c : kMalformedCases) listed.insert(std::string(c.name) + ".toml");
  std::set<std::string> present;
  for (const auto& entry : std::filesystem::directory_iterator(kMalformed)) {
    present.insert(entry.path().filename().string());
  }
  EXPECT_EQ(listed, present);
}

TEST(SceneFile, ErrorLineIsComplete) {
  const SceneError error = file_error_of(kMalformed / "wrong_unit.toml");
  EXPECT_EQ(std::string(error.what()),
            (kMalformed / "wrong_unit.toml").string() +
                ":16:13: cloth.law.stiffness = \"5 N\": wrong unit, is force [kg m/s^2], expected "
                "stiffness [N/m]");
}

TEST(SceneFile, HugeTextsAreRefusedWithoutOverflow) {
  const std::size_t kTenMegabytes = 10'000'000;
  EXPECT_THAT(error_of("x = " + std::string(kTenMegabytes, '[')).what(),
              HasSubstr("nested too deep"));
  EXPECT_THAT(error_of(std::string(kTenMegabytes, '[')).what(), HasSubstr("without a name"));
  std::string key;
  while (key.size() < kTenMegabytes) key += "a.";
  EXPECT_THAT(error_of(key + "a = 1").what(), HasSubstr("too many parts"));
  EXPECT_THAT(error_of(std::string(kMaxTextSize + 1, ' ')).what(), HasSubstr("is over 16 MB"));
  EXPECT_THAT(error_of("x = \"" + std::string(kTenMegabytes, '[') + "\"").what(),
              HasSubstr("missing key 'schema'"));
}

TEST(SceneFile, QuotesBeforeAClosingTripleBelongToTheText) {
  // Miscounted quotes would hide the nameless table from the guard.
  const SceneError error = error_of("x = \"\"\"a\"\"\"\"\"\n[#]\n");
  EXPECT_THAT(error.what(), HasSubstr(":2:1: table header without a name"));
}

TEST(SceneFile, MissingFileAndDirectoryAreOneClearError) {
  const SceneError missing = file_error_of("/nowhere/scene.toml");
  EXPECT_EQ(std::string(missing.what()),
            "/nowhere/scene.toml:1:1: no such file, expected a scene file or a catalog name");
  EXPECT_THAT(file_error_of(kMalformed).what(), HasSubstr("is a directory"));
}

/// The error for a scene in a folder of its own with a table of a cloth, whose folder above it holds
/// what its name says.
std::string error_beside(const std::string& name, const std::string& cloth) {
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("weft_beside_" + std::to_string(getpid()));
  std::filesystem::create_directories(folder / "scene");
  std::ofstream(folder / name) << "secret";
  std::filesystem::create_symlink(folder / name, folder / "scene" / name);
  const std::string start(kSmallScene.substr(0, kSmallScene.find("grid")));
  std::ofstream(folder / "scene/s.toml") << start << cloth;
  const std::string message = file_error_of(folder / "scene/s.toml").what();
  std::filesystem::remove_all(folder);
  return message;
}

TEST(SceneFile, NamesNoFileOutsideOfItsFolder) {
  struct Case {
    std::string file;
    std::string before;  ///< the name in the scene
    std::string after;
  };
  const std::string grid =
      "grid = { nodes = [3, 3], size = [\"1 m\", \"1 m\"] }\nmass = \"1 kg\"\n";
  const std::vector<Case> cases = {
      {"a.obj", "mesh = { file = \"", "\" }\nmass = \"1 kg\"\n"},
      {"a.png", grid + "texture = \"", "\"\n"},
      {"a.png", grid + "pin = [{ texture = \"", "\" }]\n"},
      {"a.glb", grid + "[[character]]\nname = \"c\"\nfile = \"", "\"\n"},
  };
  for (const Case& c : cases) {
    const auto error = [&](const std::string& name) {
      return error_beside(c.file, c.before + name + c.after);
    };
    EXPECT_THAT(error("../" + c.file), HasSubstr("leads out of the folder")) << c.before;
    EXPECT_THAT(error("/etc/" + c.file), HasSubstr("is an absolute path")) << c.before;
    EXPECT_THAT(error(c.file), HasSubstr("is a link out of the folder")) << c.before;
  }
}

TEST(SceneFile, APipeIsRefusedAtOnce) {
  const std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("weft_pipe_" + std::to_string(getpid()));
  ASSERT_EQ(mkfifo(path.c_str(), 0600), 0);
  EXPECT_THAT(file_error_of(path).what(), HasSubstr("expected a regular file"));
  std::filesystem::remove(path);
}

TEST(SceneFile, MessagesStayOnOneLine) {
  const SceneError error("a\nb", 3, 4, "say \x1b[31m \"this\"\n");
  EXPECT_EQ(std::string(error.what()), "a\\x0ab:3:4: say \\x1b[31m \"this\"\\x0a");
}

TEST(SceneFile, DefaultsAreThoseOfTheStructs) {
  const Scene scene = read_scene_text(kSmallScene, "small.toml");
  EXPECT_EQ(scene.world.gravity, World{}.gravity);
  EXPECT_EQ(scene.world.frame_interval, World{}.frame_interval);
  const Cloth& cloth = scene.cloths.at(0);
  EXPECT_EQ(cloth.grid().stencil, GridStencil::k24Neighbour);
  EXPECT_EQ(cloth.grid().lumping, MassLumping::kArea);
  EXPECT_EQ(cloth.collision_margin, Cloth{}.collision_margin);
  EXPECT_EQ(cloth.friction, Cloth{}.friction);
  EXPECT_TRUE(cloth.pins.empty());
  EXPECT_EQ(scene.bullet.position_iterations, BulletSettings{}.position_iterations);
  EXPECT_EQ(scene.reference.integrator, ReferenceSettings{}.integrator);
  EXPECT_EQ(scene.camera.position, Camera{}.position);
}

TEST(SceneFile, EveryKeyReachesTheScene) {
  const Scene scene = read_scene_text(kFullScene, "full.toml");
  EXPECT_EQ(scene.summary, "Shows \"quotes\" and a \\ in a text");
  EXPECT_EQ(scene.world.gravity, Vector3<double>(0.1, -1.0 / 3.0, 0));
  EXPECT_EQ(scene.world.time_step, 1.0 / 300.0);
  const Cloth& cloth = scene.cloths.at(0);
  EXPECT_EQ(cloth.grid().nodes, (std::array<int, 2>{5, 4}));
  EXPECT_EQ(cloth.grid().size, (std::array<double, 2>{0.7, 1.0 / 3.0}));
  EXPECT_EQ(cloth.grid().center, Vector3<double>(0.001, 0.02, 0.3));
  EXPECT_EQ(cloth.grid().stencil, GridStencil::k12Neighbour);
  EXPECT_EQ(cloth.grid().lumping, MassLumping::kUniform);
  EXPECT_DOUBLE_EQ(cloth.grid().total_mass, 0.12 * 0.7 / 3.0);
  EXPECT_EQ(cloth.velocity, Vector3<double>(1, 2, 3));
  EXPECT_EQ(cloth.pins.size(), 9U);
  EXPECT_EQ(make_mesh(cloth).pinned.size(), 20U);  // the box pin holds all nodes
  const std::vector<double> gravity = {0.1, -1.0 / 3.0, 0};
  EXPECT_EQ(cloth.laws.at(0).parameters.at("acceleration"), gravity);
  const forces::LawSpecification& drive = cloth.laws.at(1);
  EXPECT_EQ(drive.sets, (std::vector<std::string>{"hand"}));
  EXPECT_EQ(drive.parameters.at("displacement"), (std::vector<double>{0, 0, 0}));
  EXPECT_EQ(cloth.laws.at(2).parameters.at("stiffness").at(0), 1000.0 / 7.0);
  EXPECT_EQ(cloth.laws.at(2).sets, (std::vector<std::string>{"stretch", "shear", "bend"}));
  const Collider& ball = scene.colliders.at(0);
  EXPECT_EQ(std::get<SphereShape>(ball.shape).radius, 1.0 / 3.0);
  EXPECT_EQ(ball.mass, 1.0 / 9.0);
  EXPECT_EQ(std::get<BoxShape>(scene.colliders.at(1).shape).half_extents,
            Vector3<double>(0.5 / 3.0, 1.0, 1.5));
  EXPECT_TRUE(std::holds_alternative<PlaneShape>(scene.colliders.at(2).shape));
  EXPECT_EQ(scene.reference.integrator, Integrator::kTrBdf2);
  EXPECT_EQ(scene.reference.tolerance, 1e-8);
  EXPECT_EQ(scene.reference.spectral_radius, 0.25);
  EXPECT_EQ(scene.reference.contact_points, ContactPoints::kNodesAndFaces);
  EXPECT_EQ(scene.reference.contact, ContactModel::kProjection);
  EXPECT_EQ(scene.reference.step_guard, StepGuard::kSubstep);
}

TEST(SceneFile, AnImplicitEngineMayHaveItsOwnTimeStep) {
  const std::string key = "frame_interval = \"1/30 s\"\n";
  std::string text(kFullScene);
  text.insert(text.find(key) + key.size(), "implicit_time_step = \"1/60 s\"\n");
  const Scene scene = read_scene_text(text, "full.toml");
  EXPECT_EQ(with_step_of(scene, "bullet_weft").world.time_step, 1.0 / 60);
  EXPECT_EQ(with_step_of(scene, "bullet_soft").world.time_step, 1.0 / 300);
  EXPECT_EQ(with_step_of(read_scene_text(kFullScene, "full.toml"), "bullet_weft").world.time_step,
            1.0 / 300);
  EXPECT_EQ(read_scene_text(write_scene(scene), "again.toml").world.implicit_time_step, 1.0 / 60);
  EXPECT_FALSE(with_bullets_time_step(scene).world.implicit_time_step);
  text.replace(text.find("1/60 s"), 6, "1/40 s");  // 3/4 of a step in a frame
  EXPECT_THROW((void)read_scene_text(text, "full.toml"), Error);
}

TEST(SceneFile, PinsHoldTheCornersAndEdgesTheyName) {
  const auto pinned = [](const std::string& pin) {
    const std::string text = std::string(kSmallScene) + "pin = [" + pin + "]\n";
    return make_mesh(read_scene_text(text, "pins.toml").cloths.at(0)).pinned;
  };
  using Nodes = std::vector<int>;
  EXPECT_EQ(pinned("{ corner = \"-u-v\" }"), (Nodes{0}));
  EXPECT_EQ(pinned("{ corner = \"+u-v\" }"), (Nodes{2}));
  EXPECT_EQ(pinned("{ corner = \"-u+v\" }"), (Nodes{6}));
  EXPECT_EQ(pinned("{ corner = \"+u+v\" }"), (Nodes{8}));
  EXPECT_EQ(pinned("{ edge = \"-u\" }"), (Nodes{0, 3, 6}));
  EXPECT_EQ(pinned("{ edge = \"+u\" }"), (Nodes{2, 5, 8}));
  EXPECT_EQ(pinned("{ edge = \"-v\" }"), (Nodes{0, 1, 2}));
  EXPECT_EQ(pinned("{ edge = \"+v\" }"), (Nodes{6, 7, 8}));
  // v_axis is -z by default: the last row stands at z = -0.5 m.
  EXPECT_EQ(pinned("{ box = { min = [\"-1 m\", \"0 m\", \"-0.5 m\"], max = [\"0 m\", \"0 m\", "
                   "\"-0.4 m\"] } }"),
            (Nodes{6, 7}));
}

TEST(SceneFile, MovingPinsAndRegionsHoldTheirNodes) {
  const std::string text =
      std::string(kSmallScene) +
      "pin = [{ edge = \"-u\" }, { corner = \"-u-v\", velocity = [\"1 m/s\", \"2 m/s\", \"3 m/s\"] "
      "}]\n"
      "region = [{ name = \"hand\", nodes = [{ edge = \"+v\" }, { corner = \"-u-v\" }] }]\n";
  const ClothMesh mesh = make_mesh(read_scene_text(text, "pins.toml").cloths.at(0));
  EXPECT_EQ(mesh.pinned, (std::vector<int>{0, 3, 6}));
  EXPECT_EQ(mesh.pinned_velocity(0), Vector3<double>(1, 2, 3));
  EXPECT_EQ(mesh.pinned_velocity(2), Vector3<double>(0, 0, 0));
  ASSERT_EQ(mesh.node_sets.size(), 1U);
  EXPECT_EQ(mesh.node_sets[0].name, "hand");
  EXPECT_EQ(mesh.node_sets[0].nodes, (std::vector<int>{0, 6, 7, 8}));
}

TEST(SceneFile, WrittenSceneReadsBackToTheSameText) {
  for (const std::string_view text : {kFullScene, kSmallScene}) {
    const std::string written = write_scene(read_scene_text(text, "first.toml"));
    EXPECT_EQ(write_scene(read_scene_text(written, "second.toml")), written);
  }
}

TEST(SceneFile, WrittenSceneReadsBackToTheSameBits) {
  const Scene first = read_scene_text(kFullScene, "full.toml");
  const Scene second = read_scene_text(write_scene(first), "written.toml");
  EXPECT_EQ(first.world.time_step, second.world.time_step);
  EXPECT_EQ(first.camera.field_of_view, second.camera.field_of_view);
  for (std::size_t i = 0; i < first.cloths.size(); ++i) {
    EXPECT_EQ(first.cloths[i].grid().total_mass, second.cloths[i].grid().total_mass);
    EXPECT_EQ(first.cloths[i].grid().u_axis, second.cloths[i].grid().u_axis);
    EXPECT_EQ(first.cloths[i].laws.at(0).parameters, second.cloths[i].laws.at(0).parameters);
  }
  for (std::size_t i = 0; i < first.colliders.size(); ++i) {
    EXPECT_EQ(first.colliders[i].orientation.coeffs(), second.colliders[i].orientation.coeffs());
    EXPECT_EQ(first.colliders[i].angular_velocity, second.colliders[i].angular_velocity);
  }
}

constexpr std::string_view kShapes = R"(
self_collision = true
self_thickness = "17 mm"
soft_collision = true
[[collider]]
name = "capsule"
shape = "capsule"
radius = "10 cm"
height = "1/3 m"
[[collider]]
name = "cylinder"
shape = "cylinder"
radius = "10 cm"
height = "30 cm"
mass = "2 kg"
[[collider]]
name = "cone"
shape = "cone"
radius = "10 cm"
height = "30 cm"
[[collider]]
name = "stone"
shape = "convex_hull"
unit = "1 cm"
points = [[0, 0, 0], [10, 0, 0], [0, 10, 0], [0, 0, 0.1]]
[[collider]]
name = "ramp"
shape = "mesh"
unit = "1/3 m"
points = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
triangles = [[0, 1, 2], [0, 2, 3]]
[[collider]]
name = "dumbbell"
shape = "compound"
part = [
  { shape = "sphere", radius = "1/7 m", position = ["1/3 m", "0 m", "0 m"] },
  { shape = "cylinder", radius = "5 cm", height = "30 cm", orientation = { axis = [0, 0, 1], angle = "90 deg" } },
]
[[collider]]
name = "hills"
shape = "height_field"
size = ["2 m", "1/3 m"]
unit = "1 cm"
heights = [[0, 1, 0], [3, 5, -7.3]]
[bullet]
concave = "triangles"
)";

TEST(SceneFile, ShapesReadAndReadBackToTheSameBits) {
  const Scene scene = read_scene_text(std::string(kSmallScene) + std::string(kShapes), "shapes");
  EXPECT_TRUE(scene.cloths[0].self_collision && scene.cloths[0].soft_collision);
  EXPECT_EQ(scene.cloths[0].self_thickness, 0.017);
  EXPECT_EQ(scene.bullet.concave, ConcaveContact::kTriangles);
  ASSERT_EQ(scene.colliders.size(), 7U);
  EXPECT_EQ(std::get<CapsuleShape>(scene.colliders[0].shape).height, 1.0 / 3.0);
  EXPECT_EQ(scene.colliders[1].mass, 2.0);
  EXPECT_EQ(std::get<ConvexHullShape>(scene.colliders[3].shape).points(0, 1), 0.1);
  EXPECT_EQ(std::get<MeshShape>(scene.colliders[4].shape).triangles.col(1), Vector3<int>(0, 2, 3));
  const auto& compound = std::get<CompoundShape>(scene.colliders[5].shape);
  EXPECT_EQ(std::get<SphereShape>(compound.parts[0].shape).radius, 1.0 / 7.0);
  const auto& field = std::get<HeightFieldShape>(scene.colliders[6].shape);
  EXPECT_EQ(field.heights(1, 2), -7.3 * 0.01);
  const std::string written = write_scene(scene);
  const Scene back = read_scene_text(written, "written");
  EXPECT_EQ(write_scene(back), written);
  EXPECT_EQ(std::get<HeightFieldShape>(back.colliders[6].shape).heights, field.heights);
  EXPECT_EQ(std::get<MeshShape>(back.colliders[4].shape).points,
            std::get<MeshShape>(scene.colliders[4].shape).points);
}

TEST(SceneFile, EnginesAreNamedInTheirOrder) {
  const Scene all = read_scene_text(kSmallScene, "small.toml");
  EXPECT_TRUE(all.engines.empty());
  EXPECT_TRUE(is_for_engine(all, "reference"));
  const std::string text =
      "engines = [\"bullet_forces\", \"bullet_soft\"]\n" + std::string(kSmallScene);
  const Scene some = read_scene_text(text, "small.toml");
  EXPECT_EQ(some.engines, (std::vector<std::string>{"bullet_forces", "bullet_soft"}));
  EXPECT_TRUE(is_for_engine(some, "bullet_soft"));
  EXPECT_FALSE(is_for_engine(some, "reference"));
  EXPECT_EQ(read_scene_text(write_scene(some), "written.toml").engines, some.engines);
}

TEST(SceneFile, WriterRefusesWhatTheFormatCannotSay) {
  Scene scene = read_scene_text(kSmallScene, "small.toml");
  scene.cloths[0].pins = {CornerPin{.u = 1, .v = 0}};
  EXPECT_THROW((void)write_scene(scene), InvalidArgument);
  scene.cloths[0].pins.clear();
  scene.world.duration = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW((void)write_scene(scene), InvalidArgument);
}

}  // namespace
}  // namespace weft::scenes
