// Whether the fast solver solves the steps of the catalog's scenes to its tolerance, in its own words: whether these are true is
// for tests/bridge/implicit/step_error_test.cpp.
// Tested by tests/apps/CMakeLists.txt.
#include <algorithm>

#include <fmt/format.h>

#include <weft/scenes/catalog.hpp>
#include <weft/scenes/engine_kind.hpp>
#include <weft/validation/cases/scenes/scene_cases.hpp>
#include <weft/validation/cases/support/known_deviation.hpp>

namespace weft::validation {
namespace solved_steps {
namespace {

constexpr const char* kEngine = "bullet_weft";
constexpr double kMostSeconds = 3;  ///< of a scene: by then its cloth has met what it meets
/// Bending squeezes triangles of a scene whose springs are this share of what they are, and jumps where they are flat: half of the
/// steps are not solved. What a check must fail for is taken from here.
constexpr const char* kUnsolvable = "sock_puppet";
constexpr double kUnsolvableShare = 1.0 / 75;  ///< 2 N/m

struct Pace {
  std::string_view title;
  std::string_view name;
  std::optional<double> time_step;  ///< [s]; nothing: the scene's own
};
constexpr Pace kPaces[] = {{"its own step", "own", {}}, {"steps of 1/60 s", "game", 1.0 / 60}};
constexpr scenes::StoredPrecision kPrecisions[] = {scenes::StoredPrecision::kFloat32,
                                                   scenes::StoredPrecision::kFloat64};

constexpr const char* kSingle = "bullet_weft float32";
constexpr const char* kDouble = "bullet_weft float64";
constexpr MotionDeviation kStated[] = {
    {"solved_steps", kSingle, "sock_puppet in steps of 1/60 s", 0.26},
    {"solved_steps", kDouble, "sock_puppet in steps of 1/60 s", 0.26},
};
constexpr const char* kReason =
    "in long steps its folds snap through, and the budget ends while they do";

/// One step in twenty may meet too much at once.
constexpr double kMost = 0.05;
/// Scenes in which more do in steps of 1/60 s: what the cloth rests on has many facets or is cloth, and chance and rounding decide which
/// node is on which of them.
constexpr double kMostInPiles = 0.3;

Tolerance tolerance_of(std::string_view scene, const Pace& pace) {
  if ((scene == "stack" || scene == "colliders") && pace.time_step)
    return {kMostInPiles, Basis::kTruncation,
            "four layers of cloth; facets of a ring in long steps"};
  return {kMost, Basis::kTruncation, "one step in twenty may meet too much at once"};
}

std::string name_of(scenes::StoredPrecision precision) {
  return precision == scenes::StoredPrecision::kFloat32 ? "float32" : "float64";
}

std::string label_of(std::string_view scene, const Pace& pace, scenes::StoredPrecision precision) {
  return fmt::format("solved_steps_{}_{}_{}", scene, pace.name, name_of(precision));
}

scenes::Scene scene_at(std::string_view name, const Pace& pace) {
  scenes::Scene scene = scenes::load_scene(std::string(name));
  if (pace.time_step) {
    scene.world.time_step = *pace.time_step;
    scene.world.implicit_time_step.reset();
    scene.world.frame_interval = *pace.time_step;
  }
  scene.world.duration = std::min(scene.world.duration, kMostSeconds);
  return scene;
}

scenes::Scene unsolvable_scene() {
  scenes::Scene scene = scene_at(kUnsolvable, kPaces[0]);
  for (forces::LawSpecification& law : scene.cloths[0].laws) {
    if (law.law == "tension") law.parameters["stiffness"][0] *= kUnsolvableShare;
  }
  return scene;
}

std::string unsolvable_label(scenes::StoredPrecision precision) {
  return fmt::format("solved_steps_unsolvable_{}", name_of(precision));
}

bool can_run(const scenes::CatalogEntry& entry) {
  const scenes::Scene scene = scenes::load_scene(std::string(entry.name));
  return std::find(scene.engines.begin(), scene.engines.end(), kEngine) != scene.engines.end();
}

double unsolved_share(const EngineRuns& runs, const std::string& label) {
  const auto& share = runs.outcome(label).unsolved_share;
  if (!share) throw Error(label + ": says nothing of steps that were not solved");
  return *share;
}

}  // namespace
}  // namespace solved_steps

void plan_solved_steps(const CaseInfo&, const CaseOptions& options, EngineRuns& runs) {
  using namespace solved_steps;
  if (!options.bullet) return;
  for (const scenes::StoredPrecision precision : kPrecisions) {
    runs.add({unsolvable_label(precision), unsolvable_scene(), kEngine, precision});
  }
  for (const scenes::CatalogEntry& entry : scenes::scene_catalog()) {
    if (!can_run(entry)) continue;
    for (const Pace& pace : kPaces) {
      for (const scenes::StoredPrecision precision : kPrecisions) {
        runs.add({label_of(entry.name, pace, precision), scene_at(entry.name, pace), kEngine,
                  precision});
      }
    }
  }
}

void evaluate_solved_steps(const CaseInfo& info, const CaseOptions& options, const EngineRuns& runs,
                           Report& report) {
  using namespace solved_steps;
  if (!options.bullet) return;
  report.sections.push_back(
      Section{std::string(info.id), std::string(info.summary), {}, {}, {}, ""});
  for (const scenes::CatalogEntry& entry : scenes::scene_catalog()) {
    if (!can_run(entry)) continue;
    for (const Pace& pace : kPaces) {
      for (const scenes::StoredPrecision precision : kPrecisions) {
        CheckResult check;
        check.case_id = info.id;
        check.engine = fmt::format("{} {}", kEngine, name_of(precision));
        check.claim = fmt::format("{}: steps are solved to the tolerance", entry.name);
        check.metric = fmt::format("{} in {}", entry.name, pace.title);
        check.unit = "1";
        check.formula = "steps that their budget ended first, over all";
        check.source =
            "StepError, which step_error_test holds against steps solved to the last digit";
        check.measured = unsolved_share(runs, label_of(entry.name, pace, precision));
        check.tolerance = tolerance_of(entry.name, pace);
        judge_deviating(check, kStated, kReason, report);
        const double worst = unsolved_share(runs, unsolvable_label(precision));
        check.sabotages.push_back({"the unsolved steps of a sock of springs that are too soft",
                                   worst, judge(worst, *check.tolerance) == Verdict::kFail});
        report.checks.push_back(std::move(check));
      }
    }
  }
}

}  // namespace weft::validation
