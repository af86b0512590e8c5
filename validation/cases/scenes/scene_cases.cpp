#include <weft/validation/cases/scenes/scene_cases.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include <weft/scenes/catalog.hpp>
#include <weft/scenes/engine_kind.hpp>
#include <weft/validation/cases/scenes/reference_solution.hpp>
#include <weft/validation/cases/scenes/scene_section.hpp>
#include <weft/validation/referee/start_check.hpp>

namespace weft::validation {
namespace {

/// The fast solver is there for steps of a picture: that a short one is right says little of it. Scenes whose own step is as
/// long keep it.
constexpr double kFastStep = 1.0 / 100;  // [s]: divides every frame interval

scenes::Scene scene_for(const scenes::Scene& scene, const EngineChoice& engine) {
  const scenes::EngineKind* kind = scenes::find_engine_kind(engine.engine);
  if (kind == nullptr || !kind->is_implicit) return scene;
  scenes::Scene own = scenes::load_scene(scene.name);
  own.world.time_step = std::max(own.world.time_step, kFastStep);
  return scenes::with_bullets_time_step(std::move(own));
}

/// The bounds of the engines that are judged. Without Bullet the reference has nobody to serve; a recording has the bounds of one engine.
std::vector<SceneBound> judged_bounds(const std::string& id, const CaseOptions& options) {
  std::vector<SceneBound> bounds = scene_bounds(id);
  if (options.recorded) {
    const EngineChoice recording = recording_choice(options);
    std::erase_if(bounds, [&](const SceneBound& bound) {
      return bound.engine.engine != recording.bounds() ||
             bound.engine.precision != recording.precision;
    });
    for (SceneBound& bound : bounds) bound.engine = recording;
  } else if (!options.bullet) {
    std::erase_if(bounds,
                  [](const SceneBound& bound) { return bound.engine.engine != "reference"; });
  }
  return bounds;
}

std::string steps_text(const CaseOptions& options, const scenes::Scene& scene,
                       const EngineChoice& first) {
  if (options.recorded) {
    return fmt::format("; the recording {} is held to the bounds of {}",
                       options.recorded->path.string(), first.bounds());
  }
  if (!options.bullet) return "";
  return fmt::format("; bullet_weft takes steps of 1/{:.0f} s, the others of 1/{:.0f} s",
                     1 / scene_for(scene, first).world.time_step, 1 / scene.world.time_step);
}

const History* find_history(const std::vector<History>& histories, const EngineChoice& engine) {
  for (const History& history : histories) {
    if (history.engine.engine == engine.engine && history.engine.precision == engine.precision) {
      return &history;
    }
  }
  return nullptr;
}

SabotageResult try_sabotage(const SceneBound& bound, const Sabotage& sabotage,
                            const SceneMetrics& metrics, const History& history,
                            const Frames& reference) {
  Frames wrong = run_sabotaged(metrics.scene(), sabotage, bound.end);
  // A depth belongs to one run, so there the wrong run is judged, against colliders that stand
  // where they should; a distance belongs to the pair.
  const bool alone = bound.quantity == Quantity::kDepth;
  if (alone) {
    for (std::size_t f = 0; f < std::min(wrong.size(), reference.size()); ++f) {
      wrong[f].rigids = reference[f].rigids;
    }
  }
  const Frames& judged = alone ? wrong : history.frames;
  const double measured =
      bound.against == Against::kSeeds
          ? std::abs(metrics.mean_shape_number(bound.quantity, judged, bound.begin, bound.end) -
                     metrics.mean_shape_number(bound.quantity, wrong, bound.begin, bound.end))
          : metrics.largest(bound.quantity, judged, wrong, bound.begin, bound.end);
  // A mistake must show in the number that the bound holds: a sabotaged run that blows up has no such number.
  const bool noticed =
      std::isfinite(measured) && judge(measured, bound.tolerance) == Verdict::kFail;
  return {sabotage.name, measured, noticed};
}

CheckResult check_bound(const CaseInfo& info, const SceneBound& bound,
                        const ReferenceSolution& solution, const SceneMetrics& metrics,
                        const History& history, const Frames& reference) {
  CheckResult check;
  check.case_id = info.id;
  check.engine = bound.engine.title();
  check.claim = bound.claim;
  check.metric =
      bound.begin == bound.end
          ? fmt::format("{} at {:g} s", metric_text(bound.quantity), bound.end)
          : fmt::format("{}, {:g} to {:g} s", metric_text(bound.quantity), bound.begin, bound.end);
  check.unit = unit_of(bound.quantity);
  check.source = solution.source(bound);
  check.tolerance = bound.tolerance;
  check.note = bound.note;
  if (!history.failure.empty()) {
    check.measured = std::nan("");
    check.verdict = Verdict::kFail;
    check.note = history.failure;
    return check;
  }
  check.measured = solution.measured(bound, metrics, history.frames, reference);
  check.verdict = judge(check.measured, bound.tolerance);
  for (const Sabotage& sabotage : bound.sabotages) {
    check.sabotages.push_back(try_sabotage(bound, sabotage, metrics, history, reference));
  }
  return check;
}

struct KnownDeviation {
  const char* scene;  ///< empty: every scene
  const char* engine;
  const char* what;
  const char* reason;
};

constexpr KnownDeviation kDeviations[] = {
    {"", "bullet_soft", "final shape",
     "Bullet's links are projected one after the other: their stiffness follows the map of N/m "
     "exactly for a link on its own, and depends on order, iterations and time step in a mesh"},
    {"drop_ground", "bullet_soft", "where a sliding cloth stops",
     "Bullet's friction is not Coulomb's while a node slides: each contact visit takes away a "
     "fixed "
     "share of the sideways motion, so that the cloth stops almost at once; the reference slides "
     "on by v^2 / (2 mu g)"},
};

void add_deviations(const CaseInfo& info, const SceneMetrics& metrics,
                    const std::vector<History>& histories, Report& report) {
  const Frames& reference = histories.back().frames;
  if (reference.empty()) return;  // the reference itself failed: its checks say so
  for (const KnownDeviation& deviation : kDeviations) {
    if (*deviation.scene != '\0' && info.id != deviation.scene) continue;
    for (const History& history : histories) {
      if (history.engine.engine != deviation.engine || history.frames.empty()) continue;
      const double end = reference.back().time;
      const double rms =
          metrics.largest(Quantity::kRmsDistance, history.frames, reference, end, end);
      report.deviations.push_back(
          {history.engine.title(), fmt::format("{}: {}", info.id, deviation.what),
           fmt::format("RMS {:.2g} % of cloth size at {:.3g} s", 100 * rms, end),
           deviation.reason});
    }
  }
}

}  // namespace

std::vector<scenes::Scene> catalog_scene(const CaseInfo& info) {
  return {scenes::load_scene(std::string(info.id))};
}

void plan_scene(const CaseInfo& info, const CaseOptions& options, EngineRuns& runs) {
  const std::string id(info.id);
  const scenes::Scene scene = scenes::with_bullets_time_step(catalog_scene(info).front());
  for (const EngineChoice& engine : judged_engines(options)) {
    plan_run(options, id, engine, scene_for(scene, engine), runs);
  }
  ReferenceSolution(id, scene, judged_bounds(id, options)).plan(runs);
}

void evaluate_scene(const CaseInfo& info, const CaseOptions& options, const EngineRuns& runs,
                    Report& report) {
  const std::string id(info.id);
  const SceneMetrics metrics(scenes::with_bullets_time_step(catalog_scene(info).front()));
  std::vector<History> histories;
  for (const EngineChoice& engine : judged_engines(options)) {
    histories.push_back(load_history(runs, id, engine));
  }
  ReferenceSolution solution(id, metrics.scene(), judged_bounds(id, options));
  solution.load(metrics, runs);
  if (options.recorded) {
    report.checks.push_back(
        start_check(info, metrics.scene(), histories.front(), histories.back().frames));
  }
  for (const SceneBound& bound : solution.bounds()) {
    const History* history = find_history(histories, bound.engine);
    if (!history) continue;
    report.checks.push_back(
        check_bound(info, bound, solution, metrics, *history, histories.back().frames));
  }
  for (CheckResult& check : solution.own_checks(info, metrics))
    report.checks.push_back(std::move(check));
  Section section = scene_section(metrics, histories, options.pictures);
  section.summary += steps_text(options, metrics.scene(), histories.front().engine);
  Table own = solution.own_table(metrics);
  if (!own.rows.empty()) section.tables.push_back(std::move(own));
  report.sections.push_back(std::move(section));
  add_deviations(info, metrics, histories, report);
}

}  // namespace weft::validation
