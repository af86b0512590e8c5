#include <weft/scenes/recording/run.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/core.h>

#include <weft/core/error.hpp>

namespace weft::scenes {
namespace {

/// How far frame_interval / time_step may be from a whole number [-]. Both come from decimal texts,
/// so their quotient is wrong by rounding only: a few eps times the number of steps; 1e-9 covers a
/// million steps per frame.
constexpr double kWholeNumberTolerance = 1e-9;

/// More steps than a step counter holds are a mistake in the scene.
constexpr double kMaxSteps = std::numeric_limits<int>::max();

int count_steps(const char* name, double interval, double time_step) {
  const double count = interval / time_step;
  if (!(interval > 0) || !(time_step > 0) || !(count < kMaxSteps)) {
    throw InvalidArgument(
        fmt::format("record_run: {} = {} [s] with time_step = {} [s], expected > 0 "
                    "and fewer than 2^31 steps",
                    name, interval, time_step));
  }
  return static_cast<int>(std::llround(count));
}

int steps_per_frame(const World& world) {
  const int steps = count_steps("frame_interval", world.frame_interval, world.time_step);
  const double count = world.frame_interval / world.time_step;
  if (steps < 1 || std::abs(count - steps) > kWholeNumberTolerance * count) {
    throw InvalidArgument(fmt::format(
        "record_run: frame_interval = {} [s], expected a whole number of time steps of {} [s]",
        world.frame_interval, world.time_step));
  }
  return steps;
}

void write_frame(const Simulator& simulator, double time, RecordingWriter& writer,
                 RunSummary& summary) {
  SceneState state = simulator.state();
  state.time = time;
  writer.add_frame(state);
  ++summary.frames;
}

/// The steps of an engine that iterates, since the frame before.
class SolveOfFrame {
 public:
  void add(const SolveReport& report, RunSummary& summary) {
    error_ = std::max(error_, report.error);
    summary.largest_error = std::max(summary.largest_error.value_or(0.0), report.error);
    if (report.is_within_tolerance) return;
    ++unfinished_steps_;
    ++summary.unfinished_steps;
  }
  void write(double time, RecordingWriter& writer) {
    writer.add_metric("solver_error_m", time, std::exchange(error_, 0.0));
    writer.add_metric("unfinished_steps_1", time, std::exchange(unfinished_steps_, 0));
  }

 private:
  double error_ = 0.0;        ///< [m]
  int unfinished_steps_ = 0;  ///< ended by their budget
};

Resumable& resumable(Simulator& simulator) {
  if (auto* const found = dynamic_cast<Resumable*>(&simulator)) return *found;
  throw InvalidArgument(
      "record_run: the engine has no snapshots, expected scenes::Resumable beside Simulator");
}

/// The number of steps after which the snapshot is taken; 0: never.
int step_to_save(const RunSnapshots& snapshots, const World& world, int first_step, int num_steps) {
  if (!snapshots.save) return 0;
  const double time = snapshots.save_at.value_or(num_steps * world.time_step);
  const double steps = time / world.time_step;
  const double whole = std::ceil(steps * (1 - kWholeNumberTolerance));
  if (!(whole > first_step) || !(whole <= num_steps)) {
    throw InvalidArgument(
        fmt::format("record_run: snapshot at {} [s], expected a time after {:.6g} s, where the run "
                    "begins, and up to {:.6g} s",
                    time, first_step * world.time_step, num_steps * world.time_step));
  }
  return static_cast<int>(whole);
}

void resume(const RunSnapshots& snapshots, const World& world, int num_steps,
            Simulator& simulator) {
  const Snapshot& snapshot = *snapshots.resumed;
  if (snapshot.step >= num_steps) {
    throw InvalidArgument(fmt::format(
        "{}: is the state after step {}, t = {:.6g} s, expected a run that lasts longer, not "
        "{:.6g} s",
        snapshots.resumed_file, snapshot.step, snapshot.time, num_steps * world.time_step));
  }
  try {
    resumable(simulator).restore(snapshot);
  } catch (const Error& error) {
    throw InvalidArgument(snapshots.resumed_file + ": " + error.what());
  }
}

}  // namespace

RunSummary record_run(Simulator& simulator, const Scene& scene, RecordingWriter& writer,
                      const std::function<void(const StepReport&)>& progress) {
  return record_run(simulator, scene, writer, progress, {});
}

RunSummary record_run(Simulator& simulator, const Scene& scene, RecordingWriter& writer,
                      const std::function<void(const StepReport&)>& progress,
                      const RunSnapshots& snapshots) {
  const int num_steps = count_steps("duration", scene.world.duration, scene.world.time_step);
  const int frame_steps = steps_per_frame(scene.world);
  RunSummary summary;
  int step = snapshots.resumed != nullptr ? snapshots.resumed->step : 0;
  const int saved_step = step_to_save(snapshots, scene.world, step, num_steps);
  if (saved_step > 0) (void)resumable(simulator);  // before the run, not after it
  simulator.load(scene);
  if (snapshots.resumed != nullptr) resume(snapshots, scene.world, num_steps, simulator);
  double written = simulator.state().time;  // [s] of the last frame
  write_frame(simulator, written, writer, summary);
  using Clock = std::chrono::steady_clock;
  Clock::duration engine{};
  SolveOfFrame solve;
  while (step < num_steps && !summary.blow_up) {
    const Clock::time_point start = Clock::now();
    const StepReport report = simulator.step(scene.world.time_step);
    engine += Clock::now() - start;
    ++summary.steps;
    ++step;
    summary.blow_up = report.blow_up;
    if (report.solve) solve.add(*report.solve, summary);
    // The last state too where the duration is no whole number of intervals.
    const bool is_last = step == num_steps || summary.blow_up;
    // A state that has exploded already is not stepped: it is in the frame before.
    const bool is_new = !summary.blow_up || report.time > written;
    if (is_new && (step % frame_steps == 0 || is_last)) {
      written = report.time;
      write_frame(simulator, written, writer, summary);
      if (report.solve) solve.write(written, writer);
    }
    if (step == saved_step && !summary.blow_up) snapshots.save(resumable(simulator).save());
    if (progress) {
      progress(report);
    }
  }
  if (summary.blow_up) {
    writer.set_blow_up(*summary.blow_up);
  }
  summary.engine_seconds = std::chrono::duration<double>(engine).count();
  return summary;
}

}  // namespace weft::scenes
