// At rest nothing is left over: forces of the laws balance on every node that nothing holds, at any step, and the shape is one.
// Tested by tests/apps/CMakeLists.txt.
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include <weft/validation/cases/analytic/bending/elastica.hpp>
#include <weft/validation/cases/motion/motion_cases.hpp>
#include <weft/validation/cases/motion/motion_deviations.hpp>
#include <weft/validation/cases/scenes/scene_history.hpp>
#include <weft/validation/metrics/rest_forces.hpp>
#include <weft/validation/motion/motion_scenes.hpp>

namespace weft::validation {
namespace {

constexpr double kLargest = 0.05;  ///< of m g
constexpr double kMean = 0.01;
constexpr double kPlace = 1e-3;                 ///< of the size
constexpr double kTip = 0.02;                   ///< of the length
constexpr double kMostGamma = 400.0;            ///< rho g L^3 / D
constexpr double kExactStep = 1.0 / 1200;       // [s] of hammock and banner, explicitly
constexpr double kFinerExactStep = 1.0 / 4200;  // of drapes, whose nodes are lighter

struct RestRun {
  scenes::Scene scene;
  EngineChoice engine;
  std::string label;
};

std::string step_name(double step) {
  return fmt::format("{:.0f}", 1 / step);
}

RestRun run_of(const CaseInfo& info, const scenes::Scene& scene, const EngineChoice& engine,
               double step) {
  const scenes::Scene stepped = with_step(scene, step, scene.world.duration / 4);
  return {stepped, engine, fmt::format("{}_{}_{}", info.id, scene.name, step_name(step))};
}

const EngineChoice kRestExplicit{"bullet_forces", kFloat64};
const EngineChoice kFast32{"bullet_weft", kFloat32};
const EngineChoice kFast64{"bullet_weft", kFloat64};

/// Soft sheets, which explicit integration brings to rest as well. Single precision leaves more than a strip's own weight on its nodes, and on those of drapes as
/// much as is allowed.
std::vector<RestRun> runs_of(const CaseInfo& info) {
  std::vector<RestRun> list;
  for (const scenes::Scene& scene : {hammock(), banner()}) {
    list.push_back(run_of(info, scene, kRestExplicit, kExactStep));
    list.push_back(run_of(info, scene, kFast32, 1.0 / 60));
    list.push_back(run_of(info, scene, kFast64, 1.0 / 60));
  }
  for (const scenes::Scene& scene : {drape_over_box(), drape_over_ball()}) {
    list.push_back(run_of(info, scene, kRestExplicit, kFinerExactStep));
    list.push_back(run_of(info, scene, kFast64, 1.0 / 60));
  }
  for (const double step : {1.0 / 30, 1.0 / 240, 1.0 / 1000}) {
    list.push_back(run_of(info, hammock(), kFast64, step));
  }
  scenes::Scene box = sheet_over_narrow_box();
  box.world.duration = 8.0;
  list.push_back(run_of(info, box, kFast64, 1.0 / 60));
  for (const Strip& strip : typical_strips()) {
    for (const double step : {1.0 / 60, 1.0 / 240}) {
      list.push_back(run_of(info, clamped_strip(strip), kFast64, step));
    }
  }
  return list;
}

/// A scene of which the judge knows springs that are stiffer by a tenth.
scenes::Scene stiffer(scenes::Scene scene) {
  for (forces::LawSpecification& law : scene.cloths[0].laws) {
    if (law.law == "tension") law.parameters.at("stiffness").at(0) *= 1.1;
  }
  return scene;
}

CheckResult new_check(const CaseInfo& info, const RestRun& run, const std::string& figure) {
  CheckResult check;
  check.case_id = info.id;
  check.engine = run.engine.title();
  check.metric =
      fmt::format("{}, 1/{} s: {}", run.scene.name, step_name(run.scene.world.time_step), figure);
  check.unit = "1";
  return check;
}

void add_check(CheckResult check, Report& report) {
  for (SabotageResult& sabotage : check.sabotages) {
    sabotage.detected = judge(sabotage.measured, *check.tolerance) == Verdict::kFail;
  }
  judge_deviating(check, motion_deviations(), kMotionReason, report);
  report.checks.push_back(std::move(check));
}

void check_forces(const CaseInfo& info, const RestRun& run, const History& history,
                  Report& report) {
  const double epsilon = run.engine.precision == kFloat32
                             ? double{std::numeric_limits<float>::epsilon()}
                             : std::numeric_limits<double>::epsilon();
  const RestForces forces(run.scene, epsilon);
  const double kNaN = std::numeric_limits<double>::quiet_NaN();
  UnbalancedForces end{kNaN, kNaN};
  UnbalancedForces start{kNaN, kNaN};
  UnbalancedForces other{kNaN, kNaN};
  if (!history.frames.empty() && !history.blow_up) {
    end = forces.evaluate(history.frames.back());
    start = forces.evaluate(history.frames.front());
    other = RestForces(stiffer(run.scene), epsilon).evaluate(history.frames.back());
  }
  const auto add = [&](const char* name, double UnbalancedForces::*value, double allowed,
                       double rounding) {
    CheckResult check = new_check(info, run, name);
    check.claim = "no force is left over at rest";
    check.formula = "sum of forces = 0 on nodes that nothing holds";
    check.source = "the laws at the places that the engine gives";
    check.measured = end.*value;
    check.tolerance =
        Tolerance{allowed + rounding, Basis::kRoundoff,
                  fmt::format("{} of m g, and {:.2g} from rounded places", allowed, rounding)};
    check.sabotages = {{"the cloth as it starts", start.*value, false}};
    // Where too little is stretched springs do not tell.
    if (run.engine.engine != "bullet_forces" || value == &UnbalancedForces::largest) {
      check.sabotages.push_back({"springs that are stiffer by a tenth", other.*value, false});
    }
    check.note = "a solver that stops before its equations hold, or moves on";
    add_check(std::move(check), report);
  };
  add("largest force left over / (m g)", &UnbalancedForces::largest, kLargest,
      end.rounding_largest);
  add("mean force left over / (m g)", &UnbalancedForces::mean, kMean, end.rounding_mean);
}

/// Compares a hammock with explicit integration; there is one state of rest.
void check_place(const CaseInfo& info, const RestRun& run, const History& history,
                 const History& exact, Report& report) {
  const auto apart = [&](const Matrix3X<double>& places) {
    return (places - exact.frames.back().cloths[0].positions).colwise().norm().maxCoeff() /
           scenes::body_size(run.scene.cloths[0].source);
  };
  const bool has_both = !history.frames.empty() && !exact.frames.empty();
  CheckResult check = new_check(info, run, "farthest node from the rest of short steps / size");
  check.claim = "one equilibrium at any step";
  check.formula = "0";
  check.source = "bullet_forces float64 in steps of 1/1200 s";
  check.measured = has_both ? apart(history.frames.back().cloths[0].positions) : std::nan("");
  check.tolerance = Tolerance{kPlace, Basis::kTruncation, "an equilibrium knows no step"};
  check.sabotages = {{"the cloth as it starts",
                      has_both ? apart(history.frames.front().cloths[0].positions) : std::nan(""),
                      false}};
  check.note = "a rest that depends on the step";
  add_check(std::move(check), report);
}

void check_tip(const CaseInfo& info, const RestRun& run, const Strip& strip, const History& history,
               Report& report) {
  const double cell = strip.length / (strip.nodes - 1);
  // The clamp holds two columns, and ends at the second.
  const double free_length = strip.length - cell;
  const double gamma = strip.areal_density * 9.81 * std::pow(free_length, 3) / strip.rigidity;
  // A limper one bends within a few cells, where springs across the bend add to its rigidity.
  if (gamma > kMostGamma) return;
  const double drop = solve_heavy_elastica(gamma).drop * free_length;
  const auto apart = [&](const scenes::SceneState& state) {
    double fallen = 0;
    for (int row = 0; row < strip.rows; ++row) {
      fallen -= state.cloths[0].positions(1, row * strip.nodes + strip.nodes - 1);
    }
    return std::abs(fallen / strip.rows - drop) / strip.length;
  };
  CheckResult check = new_check(info, run, "drop of the tip from the elastica's / length");
  check.claim = "a strip hangs as the elastica";
  check.formula = fmt::format("{:.4f} m at Gamma = {:.3g}", drop, gamma);
  check.source = "heavy elastica";
  check.measured = history.frames.empty() ? std::nan("") : apart(history.frames.back());
  check.tolerance = Tolerance{kTip, Basis::kTruncation, "cells, and where a clamp of nodes ends"};
  check.sabotages = {{"the strip as it starts",
                      history.frames.empty() ? std::nan("") : apart(history.frames.front()),
                      false}};
  check.note = "the bending of a step that has not been solved";
  add_check(std::move(check), report);
}

}  // namespace

void plan_rest(const CaseInfo& info, const CaseOptions& options, EngineRuns& runs) {
  if (!options.bullet) return;
  for (const RestRun& run : runs_of(info)) {
    runs.add({run.engine.label(run.label), run.scene, run.engine.engine, run.engine.precision});
  }
}

void evaluate_rest(const CaseInfo& info, const CaseOptions& options, const EngineRuns& runs,
                   Report& report) {
  if (!options.bullet) return;
  const RestRun exact_run = run_of(info, hammock(), kRestExplicit, kExactStep);
  const History exact = load_history(runs, exact_run.label, kRestExplicit);
  const std::vector<Strip> strips = typical_strips();
  for (const RestRun& run : runs_of(info)) {
    const History history = load_history(runs, run.label, run.engine);
    check_forces(info, run, history, report);
    if (run.scene.name == exact_run.scene.name && run.engine.engine == "bullet_weft") {
      check_place(info, run, history, exact, report);
    }
    for (const Strip& strip : strips) {
      if (strip.name == run.scene.name) check_tip(info, run, strip, history, report);
    }
  }
  report.sections.push_back({std::string(info.id), std::string(info.summary), {}, {}, {}, ""});
}

}  // namespace weft::validation
