// Scenes in which cloth tears, through the port that all engines share and into recordings.
#include <sqlite3.h>

#include <algorithm>
#include <set>
#include <string>
#include <string_view>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <weft/core/parallel/threads.hpp>
#include <weft/engines/engine_table.hpp>
#include <weft/scenes/catalog.hpp>
#include <weft/scenes/format/scene_file.hpp>
#include <weft/scenes/recording/run.hpp>
#include <weft/scenes/torn_cloth.hpp>

#include "tests/scenes/recording/recording_samples.hpp"

namespace weft::scenes {
namespace {

using samples::same_bits;
using samples::TemporaryFolder;
using testing::HasSubstr;

/// A banner with a slit and a weak seam between two clamps that part by 2 m/s: 0.5 s in 1024 steps.
constexpr std::string_view kBanner = R"toml(
schema = "weft-scene/1"
name = "banner"
[world]
time_step = "1/2048 s"
frame_interval = "16/2048 s"
duration = "1/2 s"
[[cloth]]
name = "banner"
grid = { nodes = [25, 17], size = ["1.2 m", "80 cm"] }
center = ["0 m", "1 m", "0 m"]
v_axis = [0, 1, 0]
areal_density = "200 g/m^2"
pin = [{ edge = "-u", velocity = ["-1 m/s", "0 m/s", "0 m/s"] },
       { edge = "+u", velocity = ["1 m/s", "0 m/s", "0 m/s"] }]
region = [{ name = "seam", nodes = [{ box = { min = ["9 cm", "0 m", "-1 m"], max = ["11 cm", "2 m", "1 m"] } }] }]
tear = { strain = 0.35, variation = 0.15, weak = [{ region = "seam", strain = 0.2 }], cut = [{ from = ["10 cm", "59 cm", "0 m"], to = ["10 cm", "76 cm", "0 m"], depth = ["0 m", "0 m", "1 cm"] }] }
[[cloth.law]]
law = "gravity"
[[cloth.law]]
law = "tension"
stiffness = "2 N/m"
[[cloth.law]]
law = "spring_damping"
damping = "0.0005 N*s/m"
)toml";

Scene small_tear() {
  return read_scene_text(std::string(kBanner), "banner.toml");
}

std::unique_ptr<Simulator> make(const std::string& engine) {
  for (const EngineInfo& info : engine_table()) {
    if (info.name == engine) return info.make();
  }
  throw Error("no such engine");
}

std::vector<std::string> engines_that_tear() {
  std::vector<std::string> names;
  for (const EngineInfo& info : engine_table()) {
    if (!info.name.starts_with("bullet_deformable")) names.emplace_back(info.name);
  }
  return names;
}

int num_pieces(const ClothState& cloth) {
  std::vector<int> piece(static_cast<std::size_t>(cloth.positions.cols()));
  for (std::size_t i = 0; i < piece.size(); ++i) piece[i] = static_cast<int>(i);
  const auto root = [&](int node) {
    while (piece[static_cast<std::size_t>(node)] != node)
      node = piece[static_cast<std::size_t>(node)];
    return node;
  };
  const Triangles& triangles = cloth.topology->triangles;
  for (Eigen::Index t = 0; t < triangles.cols(); ++t) {
    for (int k = 1; k < 3; ++k) {
      const int a = root(triangles(0, t));
      const int b = root(triangles(k, t));
      piece[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
    }
  }
  std::set<int> roots;
  for (const int node : triangles.reshaped()) roots.insert(root(node));
  return static_cast<int>(roots.size());
}

/// States after every step, frames of the run.
std::vector<SceneState> run(const std::string& engine, const Scene& scene) {
  const auto simulator = make(engine);
  simulator->load(scene);
  std::vector<SceneState> states = {simulator->state()};
  const int num_steps = static_cast<int>(std::lround(scene.world.duration / scene.world.time_step));
  for (int step = 0; step < num_steps; ++step) {
    const StepReport report = simulator->step(scene.world.time_step);
    EXPECT_FALSE(report.blow_up) << report.blow_up->reason;
    if (report.blow_up) break;
    states.push_back(simulator->state());
  }
  return states;
}

class TornScene : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Engines, TornScene, testing::ValuesIn(engines_that_tear()),
                         [](const auto& info) { return info.param; });

TEST_P(TornScene, RipsIntoPiecesAndLosesNoTriangle) {
  const Scene scene = small_tear();
  const ClothMesh mesh = make_mesh(scene.cloths[0]);
  const std::vector<SceneState> states = run(GetParam(), scene);
  ASSERT_TRUE(states.front().cloths[0].topology) << "the slit is there from the start";
  EXPECT_EQ(num_pieces(states.front().cloths[0]), 1);
  EXPECT_GE(num_pieces(states.back().cloths[0]), 2);
  std::size_t before = 0;
  for (const SceneState& state : states) {
    const ClothState& cloth = state.cloths[0];
    ASSERT_EQ(cloth.topology->triangles.cols(), mesh.triangles.cols());
    ASSERT_EQ(cloth.positions.cols(), mesh.num_nodes() + std::ssize(cloth.topology->origins));
    ASSERT_EQ(cloth.velocities.cols(), cloth.positions.cols());
    ASSERT_LT(cloth.topology->triangles.maxCoeff(), cloth.positions.cols());
    ASSERT_GE(cloth.topology->origins.size(), before);
    before = cloth.topology->origins.size();
  }
  const ClothMesh drawn = drawn_mesh(mesh, states.back().cloths[0].topology.get());
  EXPECT_EQ(drawn.num_nodes(), states.back().cloths[0].positions.cols());
}

TEST_P(TornScene, APieceAtItsClampFollowsIt) {
  const Scene scene = small_tear();
  const ClothMesh mesh = make_mesh(scene.cloths[0]);
  const SceneState last = run(GetParam(), scene).back();
  for (std::size_t i = 0; i < mesh.pinned.size(); ++i) {
    const int node = mesh.pinned[i];
    const Vector3<double> expected =
        mesh.rest_positions.col(node) + last.time * mesh.pinned_velocity(i);
    // 1024 steps, each rounded to single precision in the float engines.
    EXPECT_LT((last.cloths[0].positions.col(node) - expected).norm(), 1024 * 1.2e-7);
  }
}

TEST_P(TornScene, TheSameBitsForAnyNumberOfThreads) {
  const Scene scene = small_tear();
  std::vector<SceneState> one;
  std::vector<SceneState> four;
  with_threads(1, [&] { one = run(GetParam(), scene); });
  with_threads(4, [&] { four = run(GetParam(), scene); });
  ASSERT_EQ(one.size(), four.size());
  for (std::size_t i = 0; i < one.size(); ++i) ASSERT_TRUE(same_bits(one[i], four[i])) << i;
  EXPECT_EQ(one.back().cloths[0].topology->triangles, four.back().cloths[0].topology->triangles);
}

TEST_P(TornScene, ALimitThatIsNeverReachedChangesNoBit) {
  Scene scene = small_tear();
  scene.world.duration = 128.0 / 2048;
  Scene whole = scene;
  scene.cloths[0].tear->cuts.clear();
  scene.cloths[0].tear->rule = {.strain = 1000.0};
  whole.cloths[0].tear.reset();
  const std::vector<SceneState> a = run(GetParam(), scene);
  const std::vector<SceneState> b = run(GetParam(), whole);
  for (std::size_t i = 0; i < a.size(); ++i) ASSERT_TRUE(same_bits(a[i], b[i])) << i;
}

TEST_P(TornScene, GoesToShredsWithoutACrash) {
  Scene scene = small_tear();
  scene.cloths[0].tear->rule.strain = 1e-3;
  scene.cloths[0].tear->rule.weak.clear();
  scene.cloths[0].tear->rule.max_splits = 50;
  Collider ball;
  ball.name = "ball";
  ball.shape = SphereShape{0.2};
  ball.position = {0, 0.6, 0};
  scene.colliders.push_back(ball);
  const SceneState last = run(GetParam(), scene).back();
  EXPECT_GT(num_pieces(last.cloths[0]), 20);
  EXPECT_TRUE(last.cloths[0].positions.allFinite());
}

TEST(TornScenes, EnginesThatCannotTearSaySo) {
  for (const EngineInfo& info : engine_table()) {
    if (!info.name.starts_with("bullet_deformable")) continue;
    const auto simulator = info.make();
    try {
      simulator->load(small_tear());
      ADD_FAILURE() << info.name << " did not refuse";
    } catch (const InvalidArgument& error) {
      EXPECT_THAT(error.what(), HasSubstr("cloth 'banner' tears, expected one that does not"));
    }
  }
}

TEST(TornScenes, TheBallOfTheCatalogFallsThroughTheSheet) {
  Scene scene = load_scene("tear");
  scene.world.duration = 0.55;
  const SceneState last = run("bullet_forces", scene).back();
  EXPECT_GT(last.cloths[0].topology->origins.size(), 50U);  // the slit alone opens 9 nodes
  EXPECT_LT(last.rigids[0].position.y(), 0.8);  // the sheet is at 1 m, the ball has 0.16 m
}

TEST(TornScenes, TheWrittenSceneReadsBackTheSame) {
  const Scene scene = small_tear();
  const std::string text = write_scene(scene);
  const Scene back = read_scene_text(text, "back.toml");
  EXPECT_EQ(write_scene(back), text);
  ASSERT_TRUE(back.cloths[0].tear);
  const ClothTear& a = *scene.cloths[0].tear;
  const ClothTear& b = *back.cloths[0].tear;
  EXPECT_EQ(a.rule.strain, b.rule.strain);
  EXPECT_EQ(a.rule.variation, b.rule.variation);
  EXPECT_EQ(a.rule.max_splits, b.rule.max_splits);
  ASSERT_EQ(b.rule.weak.size(), 1U);
  EXPECT_EQ(a.rule.weak[0].strain, b.rule.weak[0].strain);
  ASSERT_EQ(b.cuts.size(), 1U);
  EXPECT_EQ(a.cuts[0].from, b.cuts[0].from);
}

/// Records the small scene in the reference; returns its states at the frames.
std::vector<SceneState> record(const std::filesystem::path& path, const Scene& scene) {
  RecordingWriter writer(path, scene, {}, StoredPrecision::kFloat64, {.frames = 7});
  std::vector<SceneState> frames;
  const auto simulator = make("reference");
  simulator->load(scene);
  for (int step = 0; step <= 1024; ++step) {
    if (step > 0) (void)simulator->step(scene.world.time_step);
    if (step % 16 != 0) continue;
    frames.push_back(simulator->state());
    writer.add_frame(simulator->state());
  }
  const std::string hash = writer.finish();
  const RecordingReader reader(path);
  EXPECT_EQ(reader.content_hash(), hash);
  return frames;
}

void run_sql(const std::filesystem::path& path, const std::string& sql) {
  sqlite3* connection = nullptr;
  ASSERT_EQ(sqlite3_open(path.c_str(), &connection), SQLITE_OK);
  EXPECT_EQ(sqlite3_exec(connection, sql.c_str(), nullptr, nullptr, nullptr), SQLITE_OK)
      << sqlite3_errmsg(connection);
  sqlite3_close(connection);
}

TEST(TornRecording, ReadsBackToTheBitInAnyOrder) {
  const TemporaryFolder folder;
  const std::vector<SceneState> frames = record(folder / "torn", small_tear());
  const RecordingReader reader(folder / "torn");
  ASSERT_EQ(reader.num_frames(), std::ssize(frames));
  ASSERT_GT(frames.back().cloths[0].positions.cols(), frames.front().cloths[0].positions.cols());
  for (int i = 0; i < reader.num_frames(); ++i) {
    const int frame = (29 * i + 5) % reader.num_frames();  // forth and back; 65 frames
    const SceneState state = reader.frame(frame);
    const SceneState& expected = frames[static_cast<std::size_t>(frame)];
    ASSERT_TRUE(same_bits(state, expected)) << frame;
    ASSERT_EQ(state.cloths[0].topology->triangles, expected.cloths[0].topology->triangles);
    ASSERT_EQ(state.cloths[0].topology->origins, expected.cloths[0].topology->origins);
  }
}

TEST(TornRecording, OnlyScenesThatCanTearNeedTheNewVersion) {
  const TemporaryFolder folder;
  const auto version = [&](const std::filesystem::path& path) {
    sqlite3* connection = nullptr;
    EXPECT_EQ(sqlite3_open(path.c_str(), &connection), SQLITE_OK);
    int value = -1;
    const auto read = [](void* to, int, char** texts, char**) {
      *static_cast<int*>(to) = std::stoi(texts[0]);
      return 0;
    };
    EXPECT_EQ(sqlite3_exec(connection, "PRAGMA user_version", read, &value, nullptr), SQLITE_OK);
    sqlite3_close(connection);
    return value;
  };
  (void)record(folder / "torn", small_tear());
  EXPECT_EQ(version(folder / "torn"), 2);
  Scene whole = small_tear();
  whole.cloths[0].tear.reset();
  (void)record(folder / "whole", whole);
  EXPECT_EQ(version(folder / "whole"), 1);
}

TEST(TornRecording, RefusesStatesThatDoNotFit) {
  const TemporaryFolder folder;
  const Scene scene = small_tear();
  const auto simulator = make("reference");
  simulator->load(scene);
  RecordingWriter writer(folder / "torn", scene, {}, StoredPrecision::kFloat64);
  SceneState state = simulator->state();
  SceneState wrong = state;
  wrong.cloths[0].positions.conservativeResize(3, state.cloths[0].positions.cols() - 1);
  EXPECT_THROW(writer.add_frame(wrong), InvalidArgument);
  wrong = state;
  auto topology = std::make_shared<ClothTopology>(*state.cloths[0].topology);
  topology->triangles(0, 0) = 1'000'000;
  wrong.cloths[0].topology = topology;
  EXPECT_THROW(writer.add_frame(wrong), InvalidArgument);
  wrong = state;
  wrong.rigids.push_back({});
  EXPECT_THROW(writer.add_frame(wrong), InvalidArgument);
  writer.add_frame(state);  // none of them left a trace
  state.time += 1;
  state.cloths[0].topology.reset();
  EXPECT_THROW(writer.add_frame(state), InvalidArgument);
  const std::string hash = writer.finish();
  EXPECT_EQ(RecordingReader(folder / "torn").content_hash(), hash);
  Scene whole = scene;
  whole.cloths[0].tear.reset();
  RecordingWriter old(folder / "whole", whole, {}, StoredPrecision::kFloat64);
  EXPECT_THROW(old.add_frame(simulator->state()), InvalidArgument);
}

TEST(TornRecording, DamagedTopologiesAreErrors) {
  const TemporaryFolder folder;
  (void)record(folder / "whole", small_tear());
  int number = 0;
  for (const char* sql : {
           "DROP TABLE topology",
           "DELETE FROM topology",
           "DELETE FROM topology WHERE id = 1",
           "UPDATE topology SET nodes = nodes + 1 WHERE id = 1",
           "UPDATE topology SET nodes = -5 WHERE id = 0",
           "UPDATE topology SET body = 7 WHERE id = 0",
           "UPDATE topology SET body = -1 WHERE id = 0",
           "UPDATE topology SET first_frame = 3 WHERE id = 0",
           "UPDATE topology SET raw_bytes = 9000000000000000 WHERE id = 0",
           "UPDATE topology SET data = x'00' WHERE id = 0",
           "UPDATE topology SET hash = 'x' WHERE id = 0",
           "UPDATE topology SET data = (SELECT data FROM topology WHERE id = 0) WHERE id = 1",
           "UPDATE meta SET value = 'x' WHERE key = 'topology_hash'",
           "DELETE FROM meta WHERE key = 'topology_hash'",
           "PRAGMA user_version = 1",
       }) {
    const auto path = folder / std::to_string(number++);
    std::filesystem::copy_file(folder / "whole", path);
    run_sql(path, sql);
    EXPECT_THROW(
        {
          const RecordingReader reader(path);
          (void)reader.content_hash();
          for (int f = 0; f < reader.num_frames(); ++f) (void)reader.frame(f);
        },
        Error)
        << sql;
  }
}

}  // namespace
}  // namespace weft::scenes
