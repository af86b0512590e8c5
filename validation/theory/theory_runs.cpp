#include <weft/validation/theory/theory_runs.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include <weft/validation/cases/support/closed_form_check.hpp>

namespace weft::validation {
namespace {

/// The scene as this engine takes it. Bullet rounds its step to single precision, and so do the others here; numbers of steps
/// stay.
scenes::Scene scene_for(const TheoryScene& theory, const TheoryEngine& engine) {
  scenes::Scene scene = theory.scene;
  if (engine.steps_per_second > 0) scene.world.time_step = 1.0 / engine.steps_per_second;
  return scenes::with_bullets_time_step(std::move(scene));
}

std::string run_id(const CaseInfo& info, const TheoryScene& theory, const TheoryEngine& engine) {
  return engine.steps_per_second > 0
             ? fmt::format("{}_{}_{}", info.id, theory.id, engine.steps_per_second)
             : fmt::format("{}_{}", info.id, theory.id);
}

std::string wrong_id(const CaseInfo& info, const TheoryScene& theory, std::size_t bound,
                     std::size_t sabotage) {
  return fmt::format("{}_{}_wrong_{}_{}", info.id, theory.id, bound, sabotage);
}

bool can_run(const TheoryEngine& engine, const TheoryScene& theory) {
  return engine.steps_per_second > 0 || !theory.is_stiff;
}

bool is_complete(const History& history, const scenes::Scene& scene) {
  const auto frames =
      static_cast<std::size_t>(std::llround(scene.world.duration / scene.world.frame_interval)) + 1;
  return history.failure.empty() && !history.blow_up && history.frames.size() >= frames;
}

std::string failure_of(const History& history) {
  if (!history.failure.empty()) return history.failure;
  if (history.blow_up) {
    return fmt::format("blew up in step {} at node {}", history.blow_up->step,
                       history.blow_up->node);
  }
  return "the run has fewer frames than its duration asks for";
}

void judge_engine(const CaseInfo& info, const TheoryScene& theory, const TheoryEngine& engine,
                  const EngineRuns& runs, const std::vector<std::vector<Frames>>& sabotaged,
                  Report& report) {
  const scenes::Scene scene = scene_for(theory, engine);
  const History history = load_history(runs, run_id(info, theory, engine), engine.choice);
  const bool complete = is_complete(history, scene);
  for (std::size_t g = 0; g < theory.bounds.size(); ++g) {
    CheckResult check = judge_bound(theory.bounds[g], scene.world.time_step, complete,
                                    history.frames, sabotaged[g]);
    check.case_id = info.id;
    check.engine = engine.title();
    if (!complete) check.note = failure_of(history);
    report.checks.push_back(std::move(check));
  }
}

/// What the engines say beside the theory: one row per bound, one column per engine.
Table table_of(const CaseInfo& info, const std::vector<TheoryEngine>& engines,
               const std::vector<CheckResult>& checks) {
  Table table{"In every engine: value (relative error in % / allowed)", {"what", "expected"}, {}};
  for (const TheoryEngine& engine : engines) table.columns.push_back(engine.title());
  for (const CheckResult& check : checks) {
    if (check.case_id != info.id) continue;
    auto row = std::find_if(table.rows.begin(), table.rows.end(),
                            [&](const auto& each) { return each[0] == check.claim; });
    if (row == table.rows.end()) {
      const ComparedValue pair = check.values.empty() ? ComparedValue{} : check.values[0];
      table.rows.push_back({check.claim, fmt::format("{:.6g} {}", pair.expected,
                                                     pair.unit == "1" ? "" : pair.unit)});
      table.rows.back().resize(table.columns.size(), "-");
      row = table.rows.end() - 1;
    }
    for (std::size_t e = 0; e < engines.size(); ++e) {
      if (engines[e].title() != check.engine) continue;
      (*row)[e + 2] = check.values.empty() || !std::isfinite(check.measured)
                          ? "no value"
                          : fmt::format("{:.5g} ({:.2g} / {:.2g}){}", check.values[0].value,
                                        100 * check.measured, 100 * check.tolerance->value,
                                        check.verdict == Verdict::kPass ? "" : " FAIL");
    }
  }
  return table;
}

}  // namespace

std::string TheoryEngine::title() const {
  return steps_per_second > 0 ? fmt::format("{}, 1/{} s", choice.title(), steps_per_second)
                              : choice.title();
}

std::vector<TheoryEngine> theory_engines(bool with_bullet, const std::string& engine) {
  std::vector<TheoryEngine> all;
  if (with_bullet) {
    for (const auto precision : {kFloat32, kFloat64}) {
      for (const int steps : kTheoryStepsPerSecond) {
        all.push_back({{"bullet_weft", precision}, steps});
      }
    }
    for (const auto precision : {kFloat32, kFloat64}) all.push_back({{"bullet_forces", precision}});
  }
  all.push_back({kReference});
  if (!engine.empty()) {
    std::erase_if(all, [&](const TheoryEngine& each) { return each.choice.engine != engine; });
  }
  return all;
}

std::vector<std::string> theory_engine_names(bool with_bullet) {
  std::vector<std::string> names;
  for (const TheoryEngine& each : theory_engines(with_bullet, "")) {
    const std::string& name = each.choice.engine;
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  }
  return names;
}

void plan_theory(const CaseInfo& info, const CaseOptions& options, EngineRuns& runs) {
  for (const TheoryScene& theory : info.theory(info, options)) {
    for (const TheoryEngine& engine : theory_engines(options.bullet, options.engine)) {
      if (!can_run(engine, theory)) continue;
      runs.add({engine.choice.label(run_id(info, theory, engine)), scene_for(theory, engine),
                engine.choice.engine, engine.choice.precision});
    }
    for (std::size_t g = 0; g < theory.bounds.size(); ++g) {
      const std::vector<Sabotage>& sabotages = theory.bounds[g].sabotages;
      for (std::size_t s = 0; s < sabotages.size(); ++s) {
        scenes::Scene wrong = scene_for(theory, {kReference});
        sabotages[s].edit_scene(wrong);
        runs.add({kReference.label(wrong_id(info, theory, g, s)), wrong, kReference.engine,
                  kReference.precision});
      }
    }
  }
}

CheckResult judge_bound(const TheoryBound& bound, double time_step, bool is_complete,
                        const Frames& frames, const std::vector<Frames>& sabotaged) {
  const Tolerance tolerance = bound.tolerance(time_step);
  CheckResult check;
  check.claim = bound.claim;
  check.metric = bound.metric;
  check.unit = "1";
  check.formula = bound.formula;
  check.source = bound.source;
  check.tolerance = tolerance;
  if (is_complete) check.values = bound.values(frames);
  check.measured = check.values.empty() ? std::numeric_limits<double>::quiet_NaN()
                                        : relative_error(check.values[0]);
  check.verdict = judge(check.measured, tolerance);
  for (std::size_t s = 0; s < bound.sabotages.size(); ++s) {
    const std::vector<ComparedValue> wrong = bound.values(sabotaged[s]);
    const double measured =
        wrong.empty() ? std::numeric_limits<double>::quiet_NaN() : relative_error(wrong[0]);
    // A mistake must show in the number that the bound holds: a run that blew up has no such number.
    const bool noticed = std::isfinite(measured) && judge(measured, tolerance) == Verdict::kFail;
    check.sabotages.push_back({bound.sabotages[s].name, measured, noticed});
  }
  check.note = "the engine's solver, its step, or how it takes the law";
  return check;
}

void judge_theory(const CaseInfo& info, const CaseOptions& options, const EngineRuns& runs,
                  Report& report) {
  const std::vector<TheoryEngine> engines = theory_engines(options.bullet, options.engine);
  Report own;
  for (const TheoryScene& theory : info.theory(info, options)) {
    std::vector<std::vector<Frames>> sabotaged;
    for (std::size_t g = 0; g < theory.bounds.size(); ++g) {
      sabotaged.emplace_back();
      for (std::size_t s = 0; s < theory.bounds[g].sabotages.size(); ++s) {
        sabotaged.back().push_back(
            load_history(runs, wrong_id(info, theory, g, s), kReference).frames);
      }
    }
    for (const TheoryEngine& engine : engines) {
      if (can_run(engine, theory)) judge_engine(info, theory, engine, runs, sabotaged, own);
    }
  }
  Table table = table_of(info, engines, own.checks);
  for (CheckResult& check : own.checks) report.checks.push_back(std::move(check));
  const auto section = std::find_if(report.sections.begin(), report.sections.end(),
                                    [&](const Section& each) { return each.id == info.id; });
  if (section != report.sections.end()) {
    section->tables.push_back(std::move(table));
  } else {
    report.sections.push_back(
        {std::string(info.id), std::string(info.summary), {}, {}, {std::move(table)}, ""});
  }
}

}  // namespace weft::validation
