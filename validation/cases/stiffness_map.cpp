// How stiff a rope of Bullet's links really is: the law of one link, and what becomes of it in a chain.
#include <cmath>

#include <fmt/format.h>

#include <weft/scenes/catalog.hpp>
#include <weft/validation/cases/engine_cases.hpp>
#include <weft/validation/cases/sabotage.hpp>
#include <weft/validation/cases/scene_history.hpp>

namespace weft::validation {
namespace {

constexpr double kStiffness = 200.0;  // of every spring [N/m]
constexpr double kNodeMass = 0.05;    // [kg]
constexpr double kSpacing = 0.5;      // [m]: a step's fall of 2.7 mm stretches it by 0.5 %
constexpr double kGravity = 9.81;     // [m/s^2]
constexpr double kRate = 8.0;         // of velocity_damping [1/s]
constexpr auto kFloat64 = scenes::StoredPrecision::kFloat64;

struct Setting {
  int springs;
  double time_step;  ///< [s]
  int iterations;
  [[nodiscard]] std::string label(const CaseInfo& info) const {
    return fmt::format("{}_{}_{}_{}", info.id, springs, std::lround(1 / time_step), iterations);
  }
};

std::vector<Setting> settings() {
  std::vector<Setting> list;
  for (const int springs : {1, 2, 10, 30}) {
    for (const double time_step : {1.0 / 60, 1.0 / 240}) {
      for (const int iterations : {1, 10, 50}) list.push_back({springs, time_step, iterations});
    }
  }
  return list;
}

/// A rope that hangs from its first node, in its first place unstretched.
scenes::Scene rope_scene(const Setting& setting) {
  scenes::Scene scene = scenes::load_scene("hang");
  scene.name = "stiffness_map";
  scene.summary = "Shows a rope that hangs from its first node";
  // The slowest mode of 30 springs is damped with 3.2 rad/s or faster: rest to 1e-6.
  scene.world.time_step = setting.time_step;
  scene.world.duration = setting.springs > 10 ? 20.0 : 6.0;
  scene.world.frame_interval = scene.world.duration / 4;
  scene.colliders.clear();
  scenes::Cloth cloth = scene.cloths[0];
  scene.cloths.clear();
  const int nodes = setting.springs + 1;
  Rope rope;
  rope.nodes = nodes;
  rope.start = {0, 0, 0};
  rope.end = {0, -kSpacing * setting.springs, 0};
  rope.total_mass = kNodeMass * nodes;
  rope.lumping = MassLumping::kUniform;
  cloth.source = rope;
  cloth.pins = {scenes::NodePin{{0}}};
  cloth.moving_pins.clear();
  cloth.connections.clear();
  cloth.regions.clear();
  cloth.bulge.reset();
  cloth.velocity.setZero();
  cloth.laws = {{"gravity", {}, {{"acceleration", {0, -kGravity, 0}}}},
                {"tension", {"stretch"}, {{"stiffness", {kStiffness}}}},
                {"velocity_damping", {}, {{"rate", {kRate}}}}};
  scene.cloths.push_back(std::move(cloth));
  scene.bullet.position_iterations = setting.iterations;
  return scenes::with_bullets_time_step(scene);
}

double exact_drop(int springs) {
  return kNodeMass * kGravity * springs * (springs + 1) / (2 * kStiffness);
}

/// Stiffness of a spring over what was asked for, from how far the tip hangs down.
double stiffness_ratio(const Frames& frames, int springs) {
  if (frames.empty()) return std::nan("");
  const auto tip = frames.back().cloths[0].positions.cols() - 1;
  const double drop = -frames.back().cloths[0].positions(1, tip) - kSpacing * springs;
  return exact_drop(springs) / drop;
}

}  // namespace

void plan_stiffness_map(const CaseInfo& info, const CaseOptions& options, EngineRuns& runs) {
  if (!options.bullet) return;
  for (const Setting& setting : settings()) {
    const EngineChoice engine{"bullet_soft", kFloat64};
    runs.add(
        {engine.label(setting.label(info)), rope_scene(setting), engine.engine, engine.precision});
  }
}

void evaluate_stiffness_map(const CaseInfo& info, const CaseOptions& options,
                            const EngineRuns& runs, Report& report) {
  if (!options.bullet) return;
  const EngineChoice engine{"bullet_soft", kFloat64};
  Section section{std::string(info.id), std::string(info.summary), {}, {}, {}, ""};
  Table table{"Stiffness of a spring in a hanging rope of Bullet's links, over what was asked for",
              {"springs", "step [s]", "iterations", "ratio"},
              {}};
  double single = 0.0;
  double softest = 1e300;
  double stiffest = 0.0;
  for (const Setting& setting : settings()) {
    const History history = load_history(runs, setting.label(info), engine);
    const double ratio = stiffness_ratio(history.frames, setting.springs);
    table.rows.push_back({std::to_string(setting.springs),
                          fmt::format("1/{}", std::lround(1 / setting.time_step)),
                          std::to_string(setting.iterations), fmt::format("{:.4f}", ratio)});
    if (setting.springs == 1) {
      const double error = std::abs(ratio - 1);
      if (!(error <= single)) single = error;
    } else {
      softest = std::min(softest, ratio);
      stiffest = std::max(stiffest, ratio);
    }
  }
  CheckResult check;
  check.case_id = info.id;
  check.engine = engine.title();
  check.claim = "one link is as stiff as was asked for, at every step and number of iterations";
  check.metric = "largest relative error of its stiffness, 2 steps x 3 numbers of iterations";
  check.unit = "1";
  check.formula = "k = (mu / h^2) ((1 - kLST)^-n - 1)";
  check.source = "n projections of one link per step; statics of a hanging mass";
  check.measured = single;
  check.tolerance = {
      0.025, Basis::kTruncation,
      "Bullet's link linearises the square of its length: half the strain before it acts, "
      "1 % at 1/60 s"};
  check.verdict = judge(check.measured, *check.tolerance);
  Sabotage stiffer = stiffness_scaled(1.1);
  const Setting one{1, 1.0 / 240, 10};
  const scenes::Scene scene = rope_scene(one);
  const double sabotaged =
      std::abs(stiffness_ratio(run_sabotaged(scene, stiffer, scene.world.duration), 1) - 1);
  check.sabotages.push_back({"spring constant +10 % (in the reference)", sabotaged,
                             judge(sabotaged, *check.tolerance) == Verdict::kFail});
  check.note = "the mapping from N/m to kLST";
  report.checks.push_back(std::move(check));
  report.departures.push_back(
      {engine.title(), "stiffness_map: a spring in a rope of 2, 10 and 30",
       fmt::format("{:.3g} to {:.3g} of the stiffness that was asked for", softest, stiffest),
       "links are projected one after the other: what a chain of them gives depends on iterations "
       "and step"});
  section.tables.push_back(std::move(table));
  report.sections.push_back(std::move(section));
}

}  // namespace weft::validation
