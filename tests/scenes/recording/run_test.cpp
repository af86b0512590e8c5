#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <weft/scenes/recording/run.hpp>

#include "tests/scenes/recording/recording_samples.hpp"

namespace weft::scenes {
namespace {

using samples::make_scene;
using samples::make_state;
using samples::TemporaryFolder;

/// An engine that rounds its step, as Bullet does, and blows up when told to.
class FakeSimulator : public Simulator {
 public:
  /// stays: a step that blows up is not taken.
  explicit FakeSimulator(int blow_up_step, bool stays = false)
      : blow_up_step_(blow_up_step), stays_(stays) {}
  void load(const Scene& scene) override {
    scene_ = scene;
    state_ = make_state(scene, 0, StoredPrecision::kFloat64);
  }
  StepReport step(double time_step) override {
    ++step_;
    if (stays_ && step_ == blow_up_step_) {
      StepReport report;
      report.step = step_;
      report.time = state_.time;
      report.blow_up = BlowUp{step_, state_.time, "towel", 0, "too fast to begin with"};
      return report;
    }
    const double taken = static_cast<double>(static_cast<float>(time_step));
    const double time = state_.time + taken;
    state_ = make_state(scene_, step_, StoredPrecision::kFloat64);
    state_.time = time;
    StepReport report;
    report.step = step_;
    report.time = time;
    report.time_step = taken;
    if (step_ == blow_up_step_) {
      state_.cloths[0].positions(0, 0) = std::nan("");
      report.blow_up = BlowUp{step_, time, "towel", 0, "position is not finite"};
    }
    return report;
  }
  [[nodiscard]] const SceneState& state() const override { return state_; }

 private:
  Scene scene_;
  SceneState state_;
  int step_ = 0;
  int blow_up_step_;
  bool stays_;
};

constexpr int kNever = -1;

Scene timed_scene() {
  Scene scene = make_scene();
  scene.world.time_step = 0.01;
  scene.world.frame_interval = 0.03;
  scene.world.duration = 0.3;
  return scene;
}

TEST(RecordRun, WritesTheInitialStateAndThenOneFramePerInterval) {
  const TemporaryFolder folder;
  const Scene scene = timed_scene();
  FakeSimulator simulator(kNever);
  RecordingWriter writer(folder / "a", scene, {}, StoredPrecision::kFloat64);
  int last_step = 0;
  const RunSummary summary = record_run(simulator, scene, writer, [&](const StepReport& report) {
    EXPECT_EQ(report.step, ++last_step);
  });
  writer.finish();
  EXPECT_EQ(summary.steps, 30);
  EXPECT_EQ(last_step, 30);
  EXPECT_EQ(summary.frames, 11);
  EXPECT_FALSE(summary.blow_up.has_value());
  EXPECT_GT(summary.engine_seconds, 0.0);
  const RecordingReader reader(folder / "a");
  ASSERT_EQ(reader.num_frames(), 11);
  EXPECT_EQ(reader.frame_time(0), 0.0);
  double time = 0;
  for (int i = 0; i < 30; ++i) {
    time += static_cast<double>(0.01F);
  }
  EXPECT_EQ(reader.frame_time(10), time);  // the engine's time, not 30 * 0.01
}

TEST(RecordRun, WritesTheLastStateWhereTheDurationIsNoWholeNumberOfIntervals) {
  const TemporaryFolder folder;
  Scene scene = timed_scene();
  scene.world.duration = 0.32;  // frames after 0, 3, ... 30 steps, and 2 steps more
  FakeSimulator simulator(kNever);
  RecordingWriter writer(folder / "a", scene, {}, StoredPrecision::kFloat64);
  const RunSummary summary = record_run(simulator, scene, writer, {});
  writer.finish();
  EXPECT_EQ(summary.steps, 32);
  EXPECT_EQ(summary.frames, 12);
  const RecordingReader reader(folder / "a");
  ASSERT_EQ(reader.num_frames(), 12);
  EXPECT_EQ(reader.frame_time(11), simulator.state().time);
  EXPECT_EQ(reader.frame(11).cloths[0].positions, simulator.state().cloths[0].positions);
}

TEST(RecordRun, StopsAtABlowUpAndKeepsTheLastFrame) {
  const TemporaryFolder folder;
  const Scene scene = timed_scene();
  FakeSimulator simulator(8);
  RecordingWriter writer(folder / "a", scene, {}, StoredPrecision::kFloat64);
  const RunSummary summary = record_run(simulator, scene, writer, {});
  EXPECT_EQ(summary.steps, 8);
  EXPECT_EQ(summary.frames, 4);  // steps 0, 3, 6, 8
  ASSERT_TRUE(summary.blow_up.has_value());
  const RecordingReader reader(folder / "a");  // committed already
  ASSERT_EQ(reader.num_frames(), 4);
  EXPECT_TRUE(std::isnan(reader.frame(3).cloths[0].positions(0, 0)));
  EXPECT_EQ(reader.blow_up()->step, 8);
}

TEST(RecordRun, ABlowUpInAStepThatIsNotTakenHasTheFrameBefore) {
  for (const int step : {1, 4, 6}) {
    const TemporaryFolder folder;
    const Scene scene = timed_scene();
    FakeSimulator simulator(step, true);
    RecordingWriter writer(folder / "a", scene, {}, StoredPrecision::kFloat64);
    const RunSummary summary = record_run(simulator, scene, writer, {});
    EXPECT_EQ(summary.steps, step);
    writer.finish();
    const RecordingReader reader(folder / "a");
    ASSERT_TRUE(reader.blow_up());
    EXPECT_EQ(reader.blow_up()->step, step);
    EXPECT_EQ(reader.frame_time(reader.num_frames() - 1), simulator.state().time);
    EXPECT_EQ(reader.num_frames(), step == 6 ? 3 : 1 + step / 3);  // 5 steps: after 0, 3, 5
  }
}

TEST(RecordRun, RefusesTimesThatDoNotFit) {
  const TemporaryFolder folder;
  FakeSimulator simulator(kNever);
  RecordingWriter writer(folder / "a", timed_scene(), {}, StoredPrecision::kFloat64);
  for (const auto change :
       {+[](World& w) { w.frame_interval = 0.025; }, +[](World& w) { w.frame_interval = 0.001; },
        +[](World& w) { w.time_step = 0; }, +[](World& w) { w.duration = -1; },
        +[](World& w) { w.duration = std::nan(""); }, +[](World& w) { w.time_step = 1e-300; }}) {
    Scene scene = timed_scene();
    change(scene.world);
    EXPECT_THROW((void)record_run(simulator, scene, writer, {}), InvalidArgument);
  }
}

}  // namespace
}  // namespace weft::scenes
