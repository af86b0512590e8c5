#include <weft/viewer/live/simulation.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <functional>
#include <thread>

#include <weft/scenes/catalog.hpp>
#include <weft/scenes/recording/run.hpp>

namespace weft::viewer {
namespace {

using testing::HasSubstr;

constexpr double kFast = 1e6;  // no waiting for the clock on the wall

const scenes::EngineInfo* engine_named(std::string_view name) {
  for (const scenes::EngineInfo& engine : scenes::engine_table()) {
    if (engine.name == name) return &engine;
  }
  return nullptr;
}

SimulationSettings settings(const std::string& scene, const std::string& engine,
                            double duration = 0.2) {
  SimulationSettings settings;
  settings.scene = scenes::with_step_of(scenes::load_scene(scene), engine);
  settings.scene.world.duration = duration;
  settings.engine = engine_named(engine);
  settings.speed = kFast;
  return settings;
}

/// Waits for something that must come; the time is only for a run that hangs.
bool comes(const std::function<bool()>& condition) {
  for (int i = 0; i < 6000; ++i) {
    if (condition()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return false;
}

std::vector<std::string> engines() {
  std::vector<std::string> names;
  for (const scenes::EngineInfo& engine : scenes::engine_table()) names.emplace_back(engine.name);
  return names;
}

class LiveRun : public testing::TestWithParam<std::string> {};

TEST_P(LiveRun, HasTheBitsOfAPlainRun) {
  const std::string folder = testing::TempDir();
  const std::string name = folder + "weft_live_" + GetParam();
  const std::string live_path = name + ".weftrec";
  const std::string plain_path = name + "_plain.weftrec";
  std::filesystem::remove(live_path);
  std::filesystem::remove(plain_path);
  SimulationSettings live = settings("hang", GetParam());
  live.record = live_path;
  {
    Simulation simulation(live);
    ASSERT_TRUE(comes([&] { return simulation.reached_end() || simulation.failure(); }));
    EXPECT_EQ(simulation.failure().value_or(""), "");
    ASSERT_TRUE(comes([&] { return simulation.unfinished_recording().empty(); }));
  }
  {
    scenes::RecordingWriter writer(plain_path, live.scene, {}, live.engine->precision);
    const auto simulator = live.engine->make();
    (void)scenes::record_run(*simulator, live.scene, writer, {});
    (void)writer.finish();
  }
  const scenes::RecordingReader a(live_path);
  const scenes::RecordingReader b(plain_path);
  ASSERT_EQ(a.num_frames(), b.num_frames());
  ASSERT_EQ(a.num_frames(), 11);
  for (int f = 0; f < a.num_frames(); ++f) {
    EXPECT_EQ(a.frame_time(f), b.frame_time(f));
    EXPECT_EQ(a.frame(f).cloths[0].positions, b.frame(f).cloths[0].positions) << "frame " << f;
    EXPECT_EQ(a.frame(f).cloths[0].velocities, b.frame(f).cloths[0].velocities) << "frame " << f;
  }
  EXPECT_TRUE(a.finished());
}

INSTANTIATE_TEST_SUITE_P(Engines, LiveRun, testing::ValuesIn(engines()),
                         [](const auto& info) { return info.param; });

TEST(Simulations, AStepAtATime) {
  SimulationSettings paused = settings("hang", "reference");
  paused.is_running = false;
  Simulation simulation(paused);
  ASSERT_TRUE(comes([&] { return simulation.latest() != nullptr; }));
  EXPECT_EQ(simulation.latest()->step, 0);
  simulation.step_once();
  simulation.step_once();
  ASSERT_TRUE(comes([&] { return simulation.latest()->step == 2; }));
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  EXPECT_EQ(simulation.latest()->step, 2);
  EXPECT_EQ(simulation.num_frames(), 3u) << "single steps are kept for looking back";
  EXPECT_EQ(simulation.frame(1)->step, 1);
}

TEST(Simulations, SpeedHoldsTheRunToTheClock) {
  SimulationSettings slow = settings("hang", "reference");
  slow.speed = 0.01;
  Simulation simulation(slow);
  ASSERT_TRUE(comes([&] { return simulation.latest() != nullptr; }));
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  EXPECT_LT(simulation.latest()->state.time, 0.02);
  simulation.set_speed(kFast);
  EXPECT_TRUE(comes([&] { return simulation.latest()->state.time > 0.1; }));
}

TEST(Simulations, LawsChangeUnderWay) {
  SimulationSettings paused = settings("hang", "reference");
  paused.is_running = false;
  Simulation simulation(paused);
  ASSERT_TRUE(comes([&] { return simulation.latest() != nullptr; }));
  auto laws = paused.scene.cloths[0].laws;
  for (auto& law : laws) {
    if (law.law == "gravity") law.parameters["acceleration"] = {0.0, 500.0, 0.0};
  }
  simulation.set_laws(0, laws);
  simulation.set_running(true);
  EXPECT_TRUE(comes([&] {
    return simulation.latest()->state.cloths[0].positions.row(1).maxCoeff() > 1.5;
  })) << "the cloth rises";
  EXPECT_EQ(simulation.take_refusal(), "");
}

TEST(Simulations, APullMovesTheClothAndIsToldInNewtons) {
  SimulationSettings live = settings("hang", "reference");
  live.speed = 1.0;
  Simulation simulation(live);
  ASSERT_TRUE(comes([&] { return simulation.latest() != nullptr; }));
  simulation.set_pull(Pull{{0, 312}, {0.0, 3.0, 0.0}});
  EXPECT_TRUE(comes([&] {
    return simulation.latest()->state.cloths[0].positions(1, 312) > 1.3 &&
           simulation.latest()->pull_force > 0.0;
  }));
  EXPECT_LE(simulation.latest()->pull_force, simulation.largest_pull(0) * (1 + 1e-12));
}

TEST(Simulations, AFailureIsTold) {
  SimulationSettings bad = settings("hang", "reference");
  bad.scene.cloths[0].laws.push_back({"tension", {"no_such_set"}, {{"stiffness", {1.0}}}});
  try {
    Simulation simulation(bad);
    ASSERT_TRUE(comes([&] { return simulation.failure().has_value(); }));
    EXPECT_THAT(*simulation.failure(), HasSubstr("no_such_set"));
  } catch (const std::exception& error) {
    EXPECT_THAT(error.what(), HasSubstr("no_such_set"));
  }
}

TEST(Simulations, ARecordingThatIsCutShortIsKept) {
  const std::filesystem::path path = testing::TempDir() + "weft_live_short.weftrec";
  std::filesystem::remove(path);
  SimulationSettings live = settings("hang", "reference", 1000.0);
  live.record = path.string();
  std::string partial;
  {
    Simulation simulation(live);
    ASSERT_TRUE(comes([&] { return simulation.num_frames() > 3; }));
    partial = simulation.unfinished_recording();
  }
  ASSERT_NE(partial, "");
  EXPECT_FALSE(std::filesystem::exists(path));
  const scenes::RecordingReader reader(partial);
  EXPECT_GT(reader.num_frames(), 3);
  EXPECT_FALSE(reader.finished());
  std::filesystem::remove(partial);
}

TEST(TakingBack, LeadsToTheSameStateAgain) {
  for (const char* engine : {"reference", "bullet_weft"}) {
    if (engine_named(engine) == nullptr) continue;
    SimulationSettings paused = settings("hang", engine);
    paused.is_running = false;
    Simulation simulation(std::move(paused));
    const auto is_at = [&](int step) {
      return comes([&] { return simulation.latest() && simulation.latest()->step == step; });
    };
    for (int step = 1; step <= 4; ++step) {
      simulation.step_once();
      ASSERT_TRUE(is_at(step));
    }
    const Matrix3X<double> positions = simulation.latest()->state.cloths[0].positions;
    for (int step = 3; step >= 1; --step) {
      simulation.take_back();
      ASSERT_TRUE(is_at(step));
    }
    EXPECT_EQ(simulation.frame(simulation.num_frames() - 1)->step, 1);
    for (int step = 2; step <= 4; ++step) {
      simulation.step_once();
      ASSERT_TRUE(is_at(step));
    }
    EXPECT_EQ(simulation.latest()->state.cloths[0].positions, positions) << engine;
    EXPECT_EQ(simulation.take_refusal(), "");
  }
}

TEST(TakingBack, IsRefusedWithoutAStepByHand) {
  SimulationSettings paused = settings("hang", "reference");
  paused.is_running = false;
  Simulation simulation(std::move(paused));
  simulation.take_back();
  std::string refusal;
  EXPECT_TRUE(comes([&] { return !(refusal = simulation.take_refusal()).empty(); }));
  EXPECT_THAT(refusal, HasSubstr("no step was taken by hand"));
}

}  // namespace
}  // namespace weft::viewer
