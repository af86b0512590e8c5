#include <weft/python/bindings/scene_run.hpp>

#include <utility>

#include <fmt/format.h>

#include <weft/core/error.hpp>
#include <weft/python/bindings/signals.hpp>
#include <weft/scenes/format/scene_file.hpp>
#include <weft/scenes/recording/recording_output.hpp>
#include <weft/scenes/recording/run.hpp>

namespace weft::python {
namespace {

/// The scene with what the request asks for; it must hold to the same rules as a file.
scenes::Scene requested_scene(scenes::Scene scene, const RunRequest& request) {
  if (request.duration) scene.world.duration = *request.duration;
  if (request.time_step) {
    scene.world.time_step = *request.time_step;
    scene.world.implicit_time_step.reset();
  }
  const std::string name = "scene '" + scene.name + "'";
  scene = scenes::read_scene_text(scenes::write_scene(scene), name, scenes::files_of(scene));
  return scenes::with_step_of(std::move(scene), request.engine);
}

struct Recorded {
  scenes::RunSummary summary;
  std::string hash;
  double time = 0.0;  ///< [s] reached
};

Recorded record(const scenes::Scene& scene, const RunRequest& request,
                const scenes::RecordingOutput& output) {
  const scenes::Provenance provenance = {
      {"weft", WEFT_VERSION},
      {"program", "Python"},
      {"engine", request.engine},
      {"precision",
       request.precision == scenes::StoredPrecision::kFloat64 ? "float64" : "float32"}};
  auto writer = std::make_unique<scenes::RecordingWriter>(output.partial(), scene, provenance,
                                                          request.precision);
  const std::unique_ptr<scenes::Simulator> simulator = request.make();
  Recorded recorded;
  Signals signals;
  try {
    recorded.summary = scenes::record_run(
        *simulator, scene, *writer, [&](const scenes::StepReport& /*step*/) { signals.check(); });
    recorded.hash = writer->finish();
    recorded.time = simulator->state().time;
  } catch (...) {
    // Whatever ends the run early, its frames stay in the partial recording; without one nothing stays.
    writer->commit();
    const bool is_empty = writer->committed().frames == 0;
    writer.reset();
    if (is_empty) output.discard();
    throw;
  }
  writer.reset();
  output.publish();
  return recorded;
}

}  // namespace

py::object blow_up_dict(const std::optional<scenes::BlowUp>& blow_up) {
  if (!blow_up) return py::none();
  py::dict result;
  result["step"] = blow_up->step;
  result["time"] = blow_up->time;
  result["body"] = blow_up->body;
  result["node"] = blow_up->node;
  result["reason"] = blow_up->reason;
  return result;
}

py::dict run_scene(const scenes::Scene& scene, const RunRequest& request) {
  Recorded recorded;
  {
    const py::gil_scoped_release unlocked;
    const scenes::Scene requested = requested_scene(scene, request);
    recorded = record(requested, request, {request.output, request.may_replace});
  }
  py::dict result;
  result["steps"] = recorded.summary.steps;
  result["frames"] = recorded.summary.frames;
  result["time"] = recorded.time;
  result["blow_up"] = blow_up_dict(recorded.summary.blow_up);
  result["largest_error"] = recorded.summary.largest_error
                                ? py::object(py::float_(*recorded.summary.largest_error))
                                : py::object(py::none());
  result["unfinished_steps"] = recorded.summary.unfinished_steps;
  result["engine_seconds"] = recorded.summary.engine_seconds;
  result["content_hash"] = recorded.hash;
  return result;
}

}  // namespace weft::python
