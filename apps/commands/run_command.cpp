#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <weft/core/error.hpp>
#include <weft/core/parallel/threads.hpp>
#include <weft/core/trace.hpp>
#include <weft/engines/engine_table.hpp>
#include <weft/scenes/catalog.hpp>
#include <weft/scenes/engine_kind.hpp>
#include <weft/scenes/format/scene_file.hpp>
#include <weft/scenes/format/scene_words.hpp>
#include <weft/scenes/recording/recording.hpp>
#include <weft/scenes/recording/recording_output.hpp>
#include <weft/scenes/recording/run.hpp>
#include <weft/scenes/snapshot/snapshot_file.hpp>

#include "apps/app.hpp"
#include "apps/hand_over.hpp"
#include "apps/progress/interruption.hpp"
#include "apps/progress/progress_bar.hpp"
#include "apps/provenance.hpp"
#include "apps/quantity_option.hpp"
#include "apps/terminal.hpp"

namespace weft::app {
namespace {

struct RunOptions {
  std::string scene;
  std::string engine;
  std::string precision;
  std::string output;
  std::string duration;
  std::string time_step;
  std::string integrator;
  std::string trace;
  std::string resume;
  std::string snapshot;
  std::string snapshot_at;
  bool bullet_time_step = false;
  bool force = false;
  int threads = 0;
};

/// The engine asked for, or the first that the scene is made for.
std::string requested_engine(const RunOptions& options, const scenes::Scene& scene) {
  if (options.engine.empty())
    return scene.engines.empty() ? std::string(scenes::kReferenceEngine.name)
                                 : scene.engines.front();
  if (!scenes::is_for_engine(scene, options.engine)) {
    throw InvalidArgument(fmt::format(
        "--engine {}: scene '{}' is not made for it, expected {}{}", options.engine, scene.name,
        scene.engines.size() > 1 ? "one of " : "", fmt::join(scene.engines, ", ")));
  }
  return options.engine;
}

scenes::StoredPrecision requested_precision(const RunOptions& options) {
  if (options.engine == scenes::kReferenceEngine.name) {
    if (options.precision == "float32") {
      throw InvalidArgument("--precision float32: the reference solver has only float64");
    }
    return scenes::StoredPrecision::kFloat64;
  }
  return options.precision == "float64" ? scenes::StoredPrecision::kFloat64
                                        : scenes::StoredPrecision::kFloat32;
}

scenes::Scene requested_scene(const RunOptions& options) {
  scenes::Scene scene = scenes::load_scene(options.scene);
  if (!options.duration.empty()) {
    scene.world.duration = quantity_option("--duration", options.duration, "s");
  }
  if (!options.time_step.empty()) {
    scene.world.time_step = quantity_option("--time-step", options.time_step, "s");
    scene.world.implicit_time_step.reset();
  }
  const auto word = std::find(scenes::kIntegratorWords.begin(), scenes::kIntegratorWords.end(),
                              options.integrator);
  if (word != scenes::kIntegratorWords.end()) {
    scene.reference.integrator =
        static_cast<scenes::Integrator>(word - scenes::kIntegratorWords.begin());
  }
  // The edited scene must hold to the same rules as a file.
  scene =
      scenes::read_scene_text(scenes::write_scene(scene), options.scene, scenes::files_of(scene));
  return scene;
}

bool begins_as_trace(std::string_view beginning) {
  return beginning.starts_with("{\"displayTimeUnit\": \"ms\", \"traceEvents\": [");
}

constexpr output::FileKind kTraceKind{"a trace", begins_as_trace};

void report_stable_step(const scenes::StepReport& step) {
  if (!step.stable_time_step) return;
  const double taken = step.time_step / step.substeps;
  print("time step {:.4g} s, stable up to {:.4g} s{}{}\n", step.time_step, *step.stable_time_step,
        step.substeps > 1 ? fmt::format(", taken in {} substeps", step.substeps) : "",
        taken > *step.stable_time_step ? ": too large, modes of the springs grow" : "");
}

/// Looked at before the run, so that a bad path costs no simulation; a run without --trace has none.
/// @throws InvalidArgument if it would have a name that the recording needs.
std::optional<output::OutputFile> begin_trace(const std::string& path,
                                              const scenes::RecordingOutput& recording) {
  if (path.empty()) return std::nullopt;
  // Empty if the system cannot tell, which OutputFile reports.
  const auto place = [](const std::filesystem::path& file) {
    std::error_code ignored;
    return std::filesystem::weakly_canonical(std::filesystem::absolute(file), ignored);
  };
  const std::filesystem::path own = place(path);
  if (!own.empty() && (own == place(recording.path()) || own == place(recording.partial()))) {
    throw InvalidArgument("--trace " + path +
                          ": is a name of the recording, expected another name");
  }
  output::OutputFile file(path, kTraceKind);
  name_trace_thread("main");
  start_trace();
  return file;
}

void end_trace(const output::OutputFile& file, const std::string& recording) {
  std::ostringstream text;
  write_chrome_trace(stop_trace(), text);
  try {
    file.write(text.str());
  } catch (const Error& error) {
    throw Error(
        fmt::format("--trace {}; the recording is complete in {}", error.what(), recording));
  }
}

struct Recorded {
  scenes::RunSummary summary;
  scenes::StepReport last;
  std::string hash;
  double simulated = 0.0;  ///< [s]
};

Recorded record(const scenes::Scene& scene, const scenes::EngineInfo& engine, int threads,
                scenes::RecordingWriter& writer, const scenes::RunSnapshots& snapshots) {
  ProgressBar progress(scene.name);
  const std::unique_ptr<scenes::Simulator> simulator = engine.make();
  const Interruption interruption;
  Recorded recorded;
  const auto run = [&] {
    recorded.summary = scenes::record_run(
        *simulator, scene, writer,
        [&](const scenes::StepReport& step) {
          progress.update(step.time / scene.world.duration);
          recorded.last = step;
          Interruption::check();
        },
        snapshots);
  };
  if (threads > 0) {
    with_threads(threads, run);
  } else {
    run();
  }
  recorded.hash = writer.finish();
  recorded.simulated = simulator->state().time;
  return recorded;
}

/// What to say of a run that did not reach its end: why, and where its frames are.
std::string keep_frames(std::unique_ptr<scenes::RecordingWriter> writer,
                        const scenes::RecordingOutput& output, std::string why) {
  try {
    writer->commit();
  } catch (const Error&) {
    why += "; what came after the last commit cannot be stored";
  }
  const scenes::RecordingWriter::Committed kept = writer->committed();
  writer.reset();
  if (kept.frames == 0) {
    output.discard();
    return why;
  }
  return fmt::format("{}; {} frames up to t = {:.6g} s are kept in {}", why, kept.frames, kept.time,
                     output.partial().string());
}

/// Records into the partial recording; whatever ends the run early, its frames stay there.
Recorded record(const scenes::Scene& scene, const scenes::EngineInfo& engine, int threads,
                const scenes::Provenance& provenance, const scenes::RecordingOutput& output,
                const scenes::RunSnapshots& snapshots) {
  auto writer = std::make_unique<scenes::RecordingWriter>(output.partial(), scene, provenance,
                                                          engine.precision);
  try {
    return record(scene, engine, threads, *writer, snapshots);
  } catch (const Interrupted& stop) {
    throw Interrupted(stop.signal(), keep_frames(std::move(writer), output, stop.what()));
  } catch (const InvalidArgument& error) {
    throw InvalidArgument(keep_frames(std::move(writer), output, error.what()));
  } catch (const std::exception& error) {
    throw Error(keep_frames(std::move(writer), output, reason_of(error)));
  }
}

int report(const Recorded& recorded, const std::string& output) {
  const scenes::RunSummary& summary = recorded.summary;
  print("{}: {} steps, {} frames, {:.2f} s simulated in {:.4g} s\ncontent hash {}\n", output,
        summary.steps, summary.frames, recorded.simulated, summary.engine_seconds, recorded.hash);
  if (summary.largest_error) {
    print("{} of {} steps not solved to the tolerance; largest error of a step {:.2g} mm\n",
          summary.unfinished_steps, summary.steps, 1000 * *summary.largest_error);
  }
  if (!summary.blow_up) return kOk;
  print("blew up at step {}, t = {:.6g} s, body '{}', node {}: {}\n", summary.blow_up->step,
        summary.blow_up->time, summary.blow_up->body, summary.blow_up->node,
        summary.blow_up->reason);
  return kCaseFailed;
}

/// The snapshot to go on from; engine and precision are its own unless others are asked for.
std::optional<scenes::Snapshot> resumed_snapshot(RunOptions& options) {
  if (options.resume.empty()) return std::nullopt;
  scenes::Snapshot snapshot = scenes::read_snapshot_file(options.resume);
  if (options.engine.empty()) options.engine = snapshot.engine;
  if (options.precision.empty()) options.precision = snapshot.precision;
  return snapshot;
}

/// Where the snapshot goes, looked at before the run; a run without --snapshot and --snapshot-at leaves none.
std::optional<output::OutputFile> begin_snapshot(const RunOptions& options,
                                                 const std::string& recording) {
  if (options.snapshot.empty() && options.snapshot_at.empty()) return std::nullopt;
  std::filesystem::path path = options.snapshot;
  if (path.empty()) path = std::filesystem::path(recording).replace_extension(".weftsnap");
  return output::OutputFile(path, scenes::kSnapshotKind);
}

int run(RunOptions options, const CommandLine& command_line) {
  const std::optional<scenes::Snapshot> resumed = resumed_snapshot(options);
  scenes::Scene scene = requested_scene(options);
  options.engine = requested_engine(options, scene);
  scene = scenes::with_step_of(std::move(scene), options.engine);
  if (options.bullet_time_step) scene = scenes::with_bullets_time_step(std::move(scene));
  const scenes::StoredPrecision precision = requested_precision(options);
  if (!options.integrator.empty() && options.engine != scenes::kReferenceEngine.name) {
    throw InvalidArgument("--integrator " + options.integrator + ": " + options.engine +
                          " has Bullet's own integrator, expected --engine reference");
  }
  const scenes::EngineInfo* engine = scenes::find_engine(options.engine, precision);
  if (!engine) hand_over(command_line, precision);

  const std::string path = options.output.empty()
                               ? fmt::format("{}_{}_{}.weftrec", scene.name, options.engine,
                                             scenes::to_string(precision))
                               : options.output;
  const scenes::RecordingOutput output(path, options.force);
  for (const std::filesystem::path& earlier : output.earlier()) {
    print(stderr, "weft: {}: left by an earlier run that did not end, is kept\n", earlier.string());
  }
  scenes::Provenance provenance = build_provenance();
  provenance["engine"] = options.engine;
  provenance["precision"] = scenes::to_string(precision);
  provenance["threads"] = options.threads > 0 ? std::to_string(options.threads) : "all";

  const std::optional<output::OutputFile> trace = begin_trace(options.trace, output);
  const std::optional<output::OutputFile> snapshot = begin_snapshot(options, path);
  scenes::RunSnapshots snapshots;
  if (resumed) {
    provenance["resumed_at_step"] = std::to_string(resumed->step);
    snapshots.resumed = &*resumed;
    snapshots.resumed_file = options.resume;
  }
  if (snapshot) {
    if (!options.snapshot_at.empty()) {
      snapshots.save_at = quantity_option("--snapshot-at", options.snapshot_at, "s");
    }
    snapshots.save = [&](const scenes::Snapshot& saved) {
      snapshot->write(scenes::snapshot_bytes(saved));
      print("{}: state after step {}, t = {:.6g} s\n", snapshot->path().string(), saved.step,
            saved.time);
    };
  }
  const Recorded recorded = record(scene, *engine, options.threads, provenance, output, snapshots);
  output.publish();
  report_stable_step(recorded.last);
  const int exit_code = report(recorded, path);
  if (trace) end_trace(*trace, path);
  return exit_code;
}

}  // namespace

Action add_run_command(CLI::App& parser, const CommandLine& command_line) {
  CLI::App* command = parser.add_subcommand("run", "Simulate a scene and record it");
  auto options = std::make_shared<RunOptions>();
  command->add_option("SCENE", options->scene, "Catalog name or scene file")->required();
  command
      ->add_option("-e,--engine", options->engine,
                   "Which engine simulates (default: the first that the scene names, else the "
                   "reference)")
      ->check(CLI::IsMember(scenes::engine_names()));
  command
      ->add_option("-p,--precision", options->precision,
                   "float32 or float64; of Bullet (default float32), the reference has float64")
      ->check(CLI::IsMember({"float32", "float64"}));
  command->add_option("-o,--output", options->output,
                      "Recording to write (default SCENE_ENGINE_PRECISION.weftrec)");
  command->add_flag("-f,--force", options->force, "Replace an existing recording");
  command->add_option("--duration", options->duration, "Instead of the scene's, e.g. \"2 s\"");
  command->add_option("--time-step", options->time_step,
                      "Instead of the scene's for the engine, e.g. \"1/200 s\"");
  command
      ->add_option("--integrator", options->integrator, "Of the reference, instead of the scene's")
      ->check(CLI::IsMember(std::vector<std::string>(scenes::kIntegratorWords.begin(),
                                                     scenes::kIntegratorWords.end())));
  command->add_flag("--bullet-time-step", options->bullet_time_step,
                    "Round the time step to single precision, as Bullet does");
  command
      ->add_option("-j,--threads", options->threads,
                   "Threads of the force laws (default: all); changes no bit of the result")
      ->check(CLI::Range(1, 1024));
  command->add_option("--snapshot", options->snapshot,
                      "Write the state of the run to go on from (default with --snapshot-at: the "
                      "recording's name with .weftsnap)");
  command->add_option("--snapshot-at", options->snapshot_at,
                      "When, e.g. \"1 s\": after the first step that ends then or later (default: "
                      "after the last step)");
  command->add_option("--resume", options->resume,
                      "Go on from such a state of the same scene, engine and precision; the "
                      "recording begins there");
  command->add_option("--trace", options->trace,
                      "Write which thread did what when, as JSON that chrome://tracing and "
                      "ui.perfetto.dev open; changes no bit of the result");
  return [options, command_line] { return run(*options, command_line); };
}

}  // namespace weft::app
