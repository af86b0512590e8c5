// A hung cloth with the three damping laws, in the reference and in Bullet's world: the laws act at
// another place of another program's step, and the equations are the same.
// Tested by tests/apps/CMakeLists.txt.
#include <algorithm>
#include <cmath>
#include <utility>

#include <weft/scenes/catalog.hpp>
#include <weft/validation/cases/scenes/scene_cases.hpp>
#include <weft/validation/cases/scenes/scene_history.hpp>
#include <weft/validation/cases/support/sabotage.hpp>

namespace weft::validation {
namespace damped_hang {
namespace {

constexpr double kDuration = 0.4;  // [s]

struct Damping {
  const char* law;
  const char* parameter;
  double value;  ///< [1/s], [-] for beta
};

constexpr Damping kDampings[] = {{"acceleration_damping", "beta", 0.5},
                                 {"rotation_damping", "rate", 1.0},
                                 {"torsional_rotation_damping", "rate", 2.0}};

scenes::Scene damped_scene() {
  scenes::Scene scene = scenes::load_scene("hang");
  scene.name = "damped_hang";
  scene.summary = "Shows the cloth of hang with damped accelerations, spin and swirl";
  scene.world.duration = kDuration;
  for (const Damping& damping : kDampings) {
    scene.cloths[0].laws.push_back({damping.law, {}, {{damping.parameter, {damping.value}}}});
  }
  return scenes::with_bullets_time_step(scene);
}

std::vector<EngineChoice> engines(bool with_bullet) {
  constexpr auto kDouble = scenes::StoredPrecision::kFloat64;
  std::vector<EngineChoice> choices = {{"reference", kDouble}};
  if (with_bullet) choices.push_back({"bullet_forces", kDouble});
  return choices;
}

/// Largest distance of a node in any frame [m]; not a number if a run is short of frames.
double distance(const Frames& a, const Frames& b) {
  if (a.empty() || a.size() != b.size()) return std::nan("");
  double largest = 0;
  for (std::size_t f = 0; f < a.size(); ++f) {
    const Matrix3X<double> apart = a[f].cloths[0].positions - b[f].cloths[0].positions;
    largest = std::max(largest, apart.colwise().norm().maxCoeff());
  }
  return largest;
}

Sabotage one_percent_more(const Damping& damping) {
  Sabotage sabotage{std::string(damping.law) + " +1 %"};
  sabotage.edit_scene = [damping](scenes::Scene& scene) {
    for (forces::LawSpecification& law : scene.cloths[0].laws) {
      if (law.law == damping.law) law.parameters.at(damping.parameter).at(0) *= 1.01;
    }
  };
  return sabotage;
}

}  // namespace
}  // namespace damped_hang

void plan_damped_hang(const CaseInfo& info, const CaseOptions& options, EngineRuns& runs) {
  using namespace damped_hang;
  for (const EngineChoice& engine : engines(options.bullet)) {
    runs.add({engine.label(std::string(info.id)), damped_scene(), engine.engine, engine.precision});
  }
}

void evaluate_damped_hang(const CaseInfo& info, const CaseOptions& options, const EngineRuns& runs,
                          Report& report) {
  using namespace damped_hang;
  if (!options.bullet) return;
  const std::vector<EngineChoice> choices = engines(true);
  const Frames reference = load_history(runs, std::string(info.id), choices[0]).frames;
  const Frames bullet = load_history(runs, std::string(info.id), choices[1]).frames;
  const Tolerance tolerance{1e-9, Basis::kRoundoff,
                            "800 steps, each with eps L / h = 5e-13 m/s of velocity noise from "
                            "Bullet's positions, spread by the motion"};
  CheckResult check;
  check.case_id = info.id;
  check.engine = choices[1].title();
  check.claim = "follows the reference step for step with all three damping laws";
  check.metric = "largest node distance, 0 to 0.4 s";
  check.unit = "m";
  check.source = "the reference solver with the same step";
  check.measured = distance(bullet, reference);
  check.tolerance = tolerance;
  check.verdict = judge(check.measured, tolerance);
  check.note = "the place of the damping laws in Bullet's step (DampingPlace)";
  std::vector<Sabotage> mistakes = {one_step_dropped()};
  for (const Damping& damping : kDampings) mistakes.push_back(one_percent_more(damping));
  for (const Sabotage& mistake : mistakes) {
    const double measured = distance(bullet, run_sabotaged(damped_scene(), mistake, kDuration));
    check.sabotages.push_back(
        {mistake.name, measured, judge(measured, tolerance) == Verdict::kFail});
  }
  report.checks.push_back(std::move(check));
}

}  // namespace weft::validation
