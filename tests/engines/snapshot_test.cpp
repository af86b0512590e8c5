#include <weft/scenes/snapshot/snapshot.hpp>

#include <algorithm>
#include <memory>
#include <ostream>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <weft/core/error.hpp>
#include <weft/engines/engine_table.hpp>
#include <weft/scenes/catalog.hpp>
#include <weft/scenes/live_laws.hpp>
#include <weft/scenes/step_commands.hpp>

#include "tests/support/count.hpp"

namespace weft::scenes {
namespace {

// A part of a run is enough: what a snapshot forgets shows in the next step or the one after it.
constexpr int kStepsAfter = 12;
constexpr int kStepsBetween = 20;

std::vector<unsigned char> bytes_of(const SceneState& state) {
  std::vector<unsigned char> bytes;
  const auto add = [&](const double* numbers, Eigen::Index count) {
    const auto* const first = reinterpret_cast<const unsigned char*>(numbers);
    bytes.insert(bytes.end(), first, first + count * static_cast<Eigen::Index>(sizeof(double)));
  };
  add(&state.time, 1);
  for (const ClothState& cloth : state.cloths) {
    add(cloth.positions.data(), cloth.positions.size());
    add(cloth.velocities.data(), cloth.velocities.size());
  }
  for (const RigidState& rigid : state.rigids) {
    add(rigid.position.data(), 3);
    add(rigid.orientation.coeffs().data(), 4);
    add(rigid.velocity.data(), 3);
    add(rigid.angular_velocity.data(), 3);
  }
  return bytes;
}

using States = std::vector<std::vector<unsigned char>>;

States go_on(Simulator& engine, const Scene& scene, int num_steps) {
  States states;
  for (int i = 0; i < num_steps; ++i) {
    (void)engine.step(scene.world.time_step);
    states.push_back(bytes_of(engine.state()));
  }
  return states;
}

/// The first step whose state differs, or -1.
int first_difference(const States& a, const States& b) {
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
    if (a[i] != b[i]) return static_cast<int>(i);
  }
  return a.size() == b.size() ? -1 : static_cast<int>(std::min(a.size(), b.size()));
}

Resumable& resumable(Simulator& engine) {
  return dynamic_cast<Resumable&>(engine);
}

bool can_resume(const EngineInfo& engine) {
  return dynamic_cast<Resumable*>(engine.make().get()) != nullptr;
}

struct Run {
  EngineInfo engine;
  std::string scene;

  friend void PrintTo(const Run& run, std::ostream* out) {
    *out << run.engine.name << " " << run.scene;
  }
};

std::vector<Run> runs() {
  std::vector<Run> list;
  for (const EngineInfo& engine : engine_table()) {
    if (!can_resume(engine)) continue;
    for (const CatalogEntry& entry : scene_catalog()) {
      const Scene scene = load_scene(std::string(entry.name));
      if (is_for_engine(scene, engine.name)) list.push_back({engine, scene.name});
    }
  }
  return list;
}

class EveryRun : public testing::TestWithParam<Run> {};

TEST(Snapshot, IsTakenByEveryEngine) {
  for (const EngineInfo& info : engine_table()) EXPECT_TRUE(can_resume(info)) << info.name;
}

// Each snapshot is taken in a run that went on from the one before.
TEST_P(EveryRun, GoesOnWithTheSameBits) {
  const auto& [info, name] = GetParam();
  const Scene scene = with_step_of(load_scene(name), info.name);
  const std::unique_ptr<Simulator> engine = info.make();
  engine->load(scene);
  for (int s = 0; s < test::count(2); ++s) {
    const Snapshot snapshot = resumable(*engine).save();
    const States first = go_on(*engine, scene, kStepsAfter);

    resumable(*engine).restore(snapshot);
    EXPECT_EQ(engine->state().time, snapshot.time);
    EXPECT_EQ(first_difference(first, go_on(*engine, scene, kStepsAfter)), -1)
        << "coming back to step " << snapshot.step;

    const std::unique_ptr<Simulator> fresh = info.make();
    fresh->load(scene);
    resumable(*fresh).restore(snapshot);
    EXPECT_EQ(first_difference(first, go_on(*fresh, scene, kStepsAfter)), -1)
        << "a new engine at step " << snapshot.step;
    for (int i = 0; i < kStepsBetween; ++i) (void)engine->step(scene.world.time_step);
  }
}

// Nodes and springs come in the middle of a run: a snapshot of each step in which that happens.
TEST(SnapshotOfATear, GoesOnWithTheSameBits) {
  int num_tears = 0;
  for (const EngineInfo& info : engine_table()) {
    const Scene scene = with_step_of(load_scene("tear"), info.name);
    if (!can_resume(info) || !is_for_engine(scene, info.name)) continue;
    const std::unique_ptr<Simulator> engine = info.make();
    engine->load(scene);
    const std::unique_ptr<Simulator> fresh = info.make();
    fresh->load(scene);
    int num_of_engine = 0;
    for (int step = 0; step < 2000 && num_of_engine < 3; ++step) {
      const Eigen::Index before = engine->state().cloths[0].positions.cols();
      (void)engine->step(scene.world.time_step);
      if (engine->state().cloths[0].positions.cols() == before) continue;
      ++num_of_engine;
      const Snapshot snapshot = resumable(*engine).save();
      resumable(*fresh).restore(snapshot);
      EXPECT_EQ(
          first_difference(go_on(*engine, scene, kStepsAfter), go_on(*fresh, scene, kStepsAfter)),
          -1)
          << info.name << " at step " << snapshot.step;
    }
    num_tears += num_of_engine;
  }
  if (can_resume(engine_table().front()) && engine_table().size() > 1) {
    EXPECT_GT(num_tears, 0);
  }
}

// Suspended, led and let go again.
TEST(SnapshotOfALevelOfDetail, GoesOnWithTheSameBits) {
  for (const EngineInfo& info : engine_table()) {
    Scene scene = with_step_of(load_scene("caped_figure"), info.name);
    if (!can_resume(info) || !is_for_engine(scene, info.name)) continue;
    const double h = scene.world.time_step;
    scene.controllers.emplace_back(Detail{.cloth = "cape",
                                          .levels = {{10.5 * h, DetailLevel::kSimplified},
                                                     {20.5 * h, DetailLevel::kSkin},
                                                     {30.5 * h, DetailLevel::kFull}},
                                          .blend = 8 * h});
    const std::unique_ptr<Simulator> engine = info.make();
    engine->load(scene);
    const std::unique_ptr<Simulator> fresh = info.make();
    fresh->load(scene);
    for (int k = 0; k < 9; ++k) {
      const Snapshot snapshot = resumable(*engine).save();
      resumable(*fresh).restore(snapshot);
      EXPECT_EQ(first_difference(go_on(*engine, scene, 5), go_on(*fresh, scene, 5)), -1)
          << info.name << " at step " << snapshot.step;
    }
  }
}

// Other laws, as a window sets them.
TEST(SnapshotOfOtherLaws, GoesOnWithTheSameBits) {
  const Scene scene = load_scene("hang");
  int num_engines = 0;
  for (const EngineInfo& info : engine_table()) {
    if (!can_resume(info) || !is_for_engine(scene, info.name)) continue;
    const std::unique_ptr<Simulator> engine = info.make();
    auto* const live = dynamic_cast<LiveLaws*>(engine.get());
    if (live == nullptr)
      continue;  // Bullet's deformable world keeps the laws that it was made with
    ++num_engines;
    engine->load(scene);
    (void)go_on(*engine, scene, 5);
    std::vector<forces::LawSpecification> laws = scene.cloths[0].laws;
    laws.push_back({"velocity_damping", {}, {{"rate", {2.0}}}});
    live->replace_laws(0, laws);
    (void)go_on(*engine, scene, 5);
    const Snapshot snapshot = resumable(*engine).save();
    const std::unique_ptr<Simulator> fresh = info.make();
    fresh->load(scene);
    resumable(*fresh).restore(snapshot);
    EXPECT_EQ(first_difference(go_on(*engine, scene, 5), go_on(*fresh, scene, 5)), -1) << info.name;
  }
  const bool has_bullet = engine_table().size() > 1;
  EXPECT_GE(num_engines, has_bullet ? 4 : 1);
}

/// A snapshot, and the states that followed it when it was first gone on from.
struct Branch {
  Snapshot snapshot;
  States future;
};

// Each sequence goes back to one of the latest snapshots, takes some steps, and then often another snapshot.
void go_at_random(const Run& run, int num_sequences) {
  constexpr std::size_t kBranches = 6;
  const Scene scene = with_step_of(load_scene(run.scene), run.engine.name);
  std::mt19937 random(11);
  const auto below = [&](std::size_t end) { return static_cast<std::size_t>(random() % end); };
  const std::unique_ptr<Simulator> engine = run.engine.make();
  engine->load(scene);
  std::vector<Branch> branches;
  branches.push_back({resumable(*engine).save(), {}});
  for (int s = 0; s < num_sequences; ++s) {
    Branch& branch = branches[below(branches.size())];
    resumable(*engine).restore(branch.snapshot);
    const std::size_t num_steps = 1 + below(12);
    for (std::size_t i = 0; i < num_steps; ++i) {
      (void)engine->step(scene.world.time_step);
      const std::vector<unsigned char> state = bytes_of(engine->state());
      if (i == branch.future.size()) branch.future.push_back(state);
      ASSERT_TRUE(branch.future[i] == state)
          << "sequence " << s << ", step " << i + 1 << " after step " << branch.snapshot.step;
    }
    if (below(3) == 0) continue;
    if (branches.size() == kBranches) {
      branches.erase(branches.begin() + static_cast<std::ptrdiff_t>(below(kBranches)));
    }
    branches.push_back({resumable(*engine).save(), {}});
  }
}

void go_at_random() {
  std::vector<Run> list;
  for (const Run& run : runs()) {
    const bool is_chosen = run.scene == "hang" || run.scene == "ball_on_cloth" ||
                           run.scene == "tear" || run.scene == "flying_carpet";
    if (is_chosen) list.push_back(run);
  }
  for (const Run& run : list) {
    SCOPED_TRACE(std::string(run.engine.name) + " " + run.scene);
    go_at_random(run, test::count(8));
    if (testing::Test::HasFatalFailure()) return;
  }
}

TEST(SnapshotOfRandomSequences, GoOnWithTheSameBits) {
  go_at_random();
}

TEST(Snapshot, OfAnotherSceneOrEngineIsRefused) {
  const EngineInfo& reference = *find_engine("reference", StoredPrecision::kFloat64);
  const std::unique_ptr<Simulator> engine = reference.make();
  EXPECT_THROW((void)resumable(*engine).save(), Error);
  engine->load(load_scene("hang"));
  Snapshot snapshot = resumable(*engine).save();
  engine->load(load_scene("drop_box"));
  EXPECT_THROW(resumable(*engine).restore(snapshot), Error);
  engine->load(load_scene("hang"));
  EXPECT_NO_THROW(resumable(*engine).restore(snapshot));
  snapshot.engine = "bullet_weft";
  EXPECT_THROW(resumable(*engine).restore(snapshot), Error);
}

class Silent final : public Controller {
 public:
  void steer(const SceneState&, double, StepCommands&) override {}
};

TEST(Snapshot, OfAControllerThatDoesNotSayWhatItKnowsIsRefused) {
  const std::unique_ptr<Simulator> engine =
      find_engine("reference", StoredPrecision::kFloat64)->make();
  engine->set_controllers({std::make_shared<Silent>()});
  engine->load(load_scene("hang"));
  EXPECT_THROW((void)resumable(*engine).save(), InvalidArgument);
}

std::string name_of(const testing::TestParamInfo<Run>& run) {
  return std::string(run.param.engine.name) + "_" + run.param.scene;
}

INSTANTIATE_TEST_SUITE_P(Snapshots, EveryRun, testing::ValuesIn(runs()), name_of);

}  // namespace
}  // namespace weft::scenes
