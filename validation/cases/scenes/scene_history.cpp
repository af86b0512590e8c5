#include <weft/validation/cases/scenes/scene_history.hpp>

#include <weft/core/error.hpp>
#include <weft/engines/engine_table.hpp>

namespace weft::validation {

std::string EngineChoice::title() const {
  return engine == "reference" ? engine : engine + " " + std::string(scenes::to_string(precision));
}

std::string EngineChoice::label(const std::string& case_id) const {
  return case_id + "_" + engine + "_" + std::string(scenes::to_string(precision));
}

std::vector<EngineChoice> cross_validated_engines(bool with_bullet) {
  using scenes::StoredPrecision;
  std::vector<EngineChoice> engines;
  if (with_bullet) {
    engines = {
        {"bullet_weft", StoredPrecision::kFloat32},   {"bullet_weft", StoredPrecision::kFloat64},
        {"bullet_soft", StoredPrecision::kFloat32},   {"bullet_soft", StoredPrecision::kFloat64},
        {"bullet_forces", StoredPrecision::kFloat32}, {"bullet_forces", StoredPrecision::kFloat64}};
  }
  engines.push_back({"reference", StoredPrecision::kFloat64});
  return engines;
}

EngineChoice recording_choice(const CaseOptions& options) {
  const RecordedResult& recorded = options.recorded.value();
  return {kRecordingEngine, recorded.precision, recorded.judged_as};
}

std::vector<EngineChoice> judged_engines(const CaseOptions& options) {
  if (!options.recorded) return cross_validated_engines(options.bullet);
  return {recording_choice(options), cross_validated_engines(false).back()};
}

void plan_run(const CaseOptions& options, const std::string& id, const EngineChoice& engine,
              const scenes::Scene& scene, EngineRuns& runs) {
  if (engine.engine == kRecordingEngine) {
    runs.add_recording(engine.label(id), options.recorded.value().path);
  } else {
    runs.add({engine.label(id), scene, engine.engine, engine.precision});
  }
}

History load_history(const EngineRuns& runs, const std::string& case_id,
                     const EngineChoice& engine) {
  History history;
  history.engine = engine;
  const EngineRuns::Outcome& outcome = runs.outcome(engine.label(case_id));
  if (outcome.exit_code != 0 && outcome.exit_code != 1) {
    history.failure = "weft run ended with exit code " + std::to_string(outcome.exit_code) + ": " +
                      outcome.log.substr(0, outcome.log.find('\n'));
    return history;
  }
  try {
    const scenes::RecordingReader reader(outcome.recording);
    history.blow_up = reader.blow_up();
    history.content_hash = reader.content_hash();
    for (int frame = 0; frame < reader.num_frames(); ++frame) {
      history.frames.push_back(reader.frame(frame));
    }
  } catch (
      const Error& error) {  // a damaged recording is a failed check, not the end of the report
    history.frames.clear();
    history.failure = error.what();
  }
  return history;
}

}  // namespace weft::validation
