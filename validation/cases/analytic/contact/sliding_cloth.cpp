// A flat cloth thrown along the ground: Coulomb friction stops it after v^2 / (2 mu g).
// Tested by tests/apps/CMakeLists.txt.
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include <weft/scenes/catalog.hpp>
#include <weft/validation/cases/scenes/scene_cases.hpp>
#include <weft/validation/cases/scenes/scene_history.hpp>
#include <weft/validation/cases/support/sabotage.hpp>

namespace weft::validation {
namespace sliding_cloth {
namespace {

constexpr double kSpeed = 1.0;     // [m/s]
constexpr double kGravity = 9.81;  // [m/s^2]
constexpr double kDuration = 0.6;  // [s]: with a friction of 0.4 it stops after 0.25 s

/// drop_ground's cloth and ground, but flat, in touch from the start, and without dampers.
scenes::Scene sliding_scene() {
  scenes::Scene scene = scenes::load_scene("drop_ground");
  scene.name = "sliding_cloth";
  scene.summary = "Shows a flat cloth that slides over the ground and stops";
  scene.world.duration = kDuration;
  scenes::Cloth& cloth = scene.cloths[0];
  cloth.grid().u_axis = {1, 0, 0};
  cloth.grid().center.y() = scene.colliders[0].position.y() + cloth.collision_margin;
  cloth.velocity = {kSpeed, 0, 0};
  std::erase_if(cloth.laws, [](const forces::LawSpecification& law) {
    return law.law == "velocity_damping" || law.law == "spring_damping";
  });
  return scenes::with_bullets_time_step(scene);
}

double stopping_distance(const scenes::Scene& scene) {
  const double friction = scene.cloths[0].friction * scene.colliders[0].friction;
  return kSpeed * kSpeed / (2 * friction * kGravity);
}

/// How far the middle of the cloth went in a run, minus theory [m].
double error(const Frames& frames, const scenes::Scene& scene) {
  const auto middle = [](const scenes::SceneState& state) {
    return state.cloths[0].positions.row(0).mean();
  };
  return std::abs(middle(frames.back()) - middle(frames.front()) - stopping_distance(scene));
}

CheckResult make_check(const CaseInfo& info, const std::string& engine) {
  CheckResult check;
  check.case_id = info.id;
  check.engine = engine;
  check.claim = "a sliding cloth stops where Coulomb's law says";
  check.metric = "error of the stopping distance";
  check.unit = "m";
  check.formula = "v^2 / (2 mu g)";
  check.source = "point mass with Coulomb friction; the cloth moves as a whole";
  check.note = "tangential impulses, the friction product, or a contact that is lost";
  return check;
}

}  // namespace
}  // namespace sliding_cloth

void plan_sliding_cloth(const CaseInfo& info, const CaseOptions& options, EngineRuns& runs) {
  using namespace sliding_cloth;
  for (const EngineChoice& engine : cross_validated_engines(options.bullet)) {
    runs.add(
        {engine.label(std::string(info.id)), sliding_scene(), engine.engine, engine.precision});
  }
}

void evaluate_sliding_cloth(const CaseInfo& info, const CaseOptions& options,
                            const EngineRuns& runs, Report& report) {
  using namespace sliding_cloth;
  const scenes::Scene scene = sliding_scene();
  const Tolerance tolerance{kSpeed * scene.world.time_step, Basis::kTruncation,
                            "v h: a sum over steps misses the integral by half of that"};
  for (const EngineChoice& engine : cross_validated_engines(options.bullet)) {
    CheckResult check = make_check(info, engine.title());
    const History history = load_history(runs, std::string(info.id), engine);
    check.measured = history.frames.empty() ? std::nan("") : error(history.frames, scene);
    if (engine.engine != "bullet_soft") {
      check.tolerance = tolerance;
      check.verdict = judge(check.measured, tolerance);
      for (const Sabotage& sabotage : {friction_removed(), initial_velocity_unset()}) {
        const double measured = error(run_sabotaged(scene, sabotage, kDuration), scene);
        check.sabotages.push_back(
            {sabotage.name, measured, judge(measured, tolerance) == Verdict::kFail});
      }
    } else {
      report.deviations.push_back(
          {engine.title(), "sliding_cloth: stopping distance",
           fmt::format("{:.3g} m off {:.3g} m", check.measured, stopping_distance(scene)),
           "each visit of a sliding contact takes away a fixed share of the sideways motion, not "
           "mu "
           "times the normal force"});
    }
    report.checks.push_back(std::move(check));
  }
}

}  // namespace weft::validation
