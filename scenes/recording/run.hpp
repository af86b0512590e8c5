#pragma once

#include <functional>
#include <optional>
#include <string>

#include <weft/scenes/recording/recording.hpp>
#include <weft/scenes/simulator.hpp>
#include <weft/scenes/snapshot/snapshot.hpp>

namespace weft::scenes {

/// What came of a run.
struct RunSummary {
  int steps = 0;   ///< taken, the one that blew up included
  int frames = 0;  ///< written, the initial one included
  std::optional<BlowUp> blow_up;
  /// An engine that iterates gives the largest error of a step [m] and the number of steps whose budget ended first.
  std::optional<double> largest_error;
  int unfinished_steps = 0;
  double engine_seconds = 0.0;  ///< [s] wall time in Simulator::step alone
};

/// A run that begins with a snapshot, or leaves one.
struct RunSnapshots {
  const Snapshot* resumed = nullptr;  ///< to begin with, in place of the scene's first state
  std::string resumed_file = {};      ///< its name, for messages
  std::optional<double> save_at =
      std::nullopt;  ///< [s] the first step that ends then or later; none: after the last step
  std::function<void(const Snapshot&)> save =
      nullptr;  ///< gets the snapshot; nullptr: none is taken
};

/// Runs the scene for world.duration in steps of world.time_step, and writes the initial state and
/// then a frame every world.frame_interval, and the last state in any case. A blow-up ends the run; it is
/// recorded, with the state after it as last frame; that is the frame before if the engine did not take the
/// step. Frame times are the engine's own. The recording is left unfinished, so that metrics can follow. progress, if there is one, is called after every step; what it throws ends the run. Throws
/// InvalidArgument if the times are not positive or frame_interval is not a whole number of steps,
/// and what load() and the writer throw.
[[nodiscard]] RunSummary record_run(Simulator& simulator, const Scene& scene,
                                    RecordingWriter& writer,
                                    const std::function<void(const StepReport&)>& progress);

/// The same with snapshots. A run that is resumed takes the steps that are left to world.duration, and its first frame is the
/// state that was saved. Throws InvalidArgument for an engine that has no snapshots and for a time to save at that the run does
/// not reach, and what Resumable throws.
[[nodiscard]] RunSummary record_run(Simulator& simulator, const Scene& scene,
                                    RecordingWriter& writer,
                                    const std::function<void(const StepReport&)>& progress,
                                    const RunSnapshots& snapshots);

}  // namespace weft::scenes
