// Falls, impacts and loads: what must come out is known from explicit integration in short steps, or from theory.
// Tested by tests/apps/CMakeLists.txt.
#include <cmath>

#include <fmt/format.h>

#include <weft/validation/cases/motion/motion_cases.hpp>
#include <weft/validation/cases/motion/motion_deviations.hpp>
#include <weft/validation/cases/scenes/scene_history.hpp>
#include <weft/validation/motion/motion_figures.hpp>
#include <weft/validation/motion/motion_scenes.hpp>

namespace weft::validation {
namespace {

const EngineChoice kExact{"bullet_forces", kFloat64};
/// In single precision, as programs have Bullet: where rounding decides, double precision goes astray elsewhere.
const EngineChoice kImpactsJudged[] = {{"bullet_weft", kFloat32}};

std::vector<MotionScene> motions() {
  std::vector<MotionScene> list = judged_motions();
  for (MotionScene& motion : judged_impacts()) list.push_back(std::move(motion));
  return list;
}

scenes::Scene exact_scene(const MotionScene& motion) {
  return with_step(motion.scene, motion.exact_step, motion.scene.world.frame_interval);
}

std::string label_of(const CaseInfo& info, const MotionScene& motion) {
  return fmt::format("{}_{}", info.id, motion.scene.name);
}

Tolerance tolerance_of(const MotionFigure& figure) {
  if (figure.is_bound) {
    return {figure.allowed, Basis::kRoundoff,
            "zero by Newton's laws; rounding of places, and a contact that is a little inside"};
  }
  return {figure.allowed, Basis::kModelGap,
          "what a step of 1/60 s may change of it; the explicit run's discretization error is a "
          "tenth of that"};
}

CheckResult check_of(const CaseInfo& info, const MotionScene& motion, const MotionFigure& figure,
                     const EngineChoice& engine, double value, double right) {
  CheckResult check;
  check.case_id = info.id;
  check.engine = engine.title();
  check.claim = figure.is_bound ? "nothing comes from nowhere" : "moves as in short steps";
  check.metric = fmt::format("{}: {}", motion.scene.name, figure.name);
  check.unit = figure.is_relative ? "1" : figure.unit;
  check.formula = figure.is_bound ? "0" : fmt::format("{:.5g} {}", right, figure.unit);
  check.source = figure.is_bound
                     ? "conservation; drag and contact only take"
                     : fmt::format("bullet_forces float64 in steps of {:.3g} s", motion.exact_step);
  check.measured = figure.deviation(value, right);
  check.tolerance = tolerance_of(figure);
  const double wrong =
      figure.deviation(figure.of(motion.scene, wrong_motion(motion.scene, figure.wrong)), right);
  check.sabotages.push_back(
      {to_string(figure.wrong), wrong, judge(wrong, *check.tolerance) == Verdict::kFail});
  check.note = "motion that the solver loses or makes, or an impulse that only one side gets";
  return check;
}

}  // namespace

void plan_impacts(const CaseInfo& info, const CaseOptions& options, EngineRuns& runs) {
  if (!options.bullet) return;
  for (const MotionScene& motion : motions()) {
    const std::string id = label_of(info, motion);
    runs.add({kExact.label(id), exact_scene(motion), kExact.engine, kExact.precision});
    for (const EngineChoice& engine : kImpactsJudged) {
      runs.add({engine.label(id), motion.scene, engine.engine, engine.precision});
    }
  }
}

void evaluate_impacts(const CaseInfo& info, const CaseOptions& options, const EngineRuns& runs,
                      Report& report) {
  if (!options.bullet) return;
  Section section{std::string(info.id), std::string(info.summary), {}, {}, {}, ""};
  Table table{"Figures", {"scene", "figure", "unit", "short steps"}, {}};
  for (const EngineChoice& engine : kImpactsJudged) table.columns.push_back(engine.title());
  for (const MotionScene& motion : motions()) {
    const std::string id = label_of(info, motion);
    const History exact = load_history(runs, id, kExact);
    std::vector<History> histories;
    for (const EngineChoice& engine : kImpactsJudged)
      histories.push_back(load_history(runs, id, engine));
    for (const MotionFigure& figure : motion.figures) {
      const double right = figure.of(exact_scene(motion), exact.frames);
      std::vector<std::string> row = {motion.scene.name, figure.name, figure.unit,
                                      fmt::format("{:.4g}", right)};
      if (figure.is_bound) {
        CheckResult check = check_of(info, motion, figure, kExact, right, 0.0);
        judge_deviating(check, {}, {}, report);
        report.checks.push_back(std::move(check));
      }
      for (const History& history : histories) {
        const double value = figure.of(motion.scene, history.frames);
        CheckResult check = check_of(info, motion, figure, history.engine, value, right);
        judge_deviating(check, motion_deviations(), kMotionReason, report);
        report.checks.push_back(std::move(check));
        row.push_back(fmt::format("{:.4g}", value));
      }
      table.rows.push_back(std::move(row));
    }
  }
  section.tables.push_back(std::move(table));
  report.sections.push_back(std::move(section));
}

}  // namespace weft::validation
