#include <weft/validation/cases/support/reference_levels.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include <weft/validation/cases/support/sabotage.hpp>

namespace weft::validation {
namespace {

constexpr double kCoarseStep = 0.01;  // [s]

std::vector<int> divisions(const LevelPlan& plan) {
  return {std::max(1, plan.finest_division / 4), std::max(1, plan.finest_division / 2),
          plan.finest_division};
}

std::string level_id(const LevelPlan& plan, int division) {
  return fmt::format("{}_level_{}", plan.id, division);
}

/// Steps of 1/100 s, or of the frame where that is shorter: implicit Euler, for nothing else is stable there.
Sabotage coarse_step(const scenes::Scene& scene) {
  const double step = std::min(kCoarseStep, scene.world.frame_interval);
  Sabotage sabotage{fmt::format("steps of {:g} s (implicit Euler) in the finest level", step)};
  sabotage.edit_scene = [step](scenes::Scene& edited) {
    edited.world.time_step = step;
    edited.reference.integrator = scenes::Integrator::kImplicitEuler;
  };
  return sabotage;
}

/// Maximum that does not swallow a NaN.
double larger_change(double a, double b) {
  return std::isnan(a) || std::isnan(b) ? std::numeric_limits<double>::quiet_NaN() : std::max(a, b);
}

}  // namespace

void plan_levels(const LevelPlan& plan, EngineRuns& runs) {
  for (const int division : divisions(plan)) {
    scenes::Scene scene = plan.scene;
    scene.world.time_step /= division;
    scene.reference.integrator = scenes::Integrator::kVelocityVerlet;
    runs.add({kReference.label(level_id(plan, division)), scene, kReference.engine,
              kReference.precision});
  }
}

ReferenceLevels::ReferenceLevels(const LevelPlan& plan, const EngineRuns& runs)
    : finest_step_(plan.scene.world.time_step / plan.finest_division),
      order_{plan.scene.colliders.empty() ? 2.0 : 1.0, 2.0} {
  for (const int division : divisions(plan)) {
    levels_.push_back(load_history(runs, level_id(plan, division), kReference).frames);
  }
}

ReferenceLevels::OwnError ReferenceLevels::discretization_error(const SceneMetrics& metrics,
                                                                const Window& window,
                                                                const Frames& finest) const {
  const auto apart = [&](const Frames& a, const Frames& b) {
    return metrics.largest(window.quantity, a, b, window.begin, window.end);
  };
  OwnError error{apart(levels_[0], levels_[1]), apart(levels_[1], finest), {}};
  error.study = study_norms(error.fine, error.coarse, 2.0, order_);
  return error;
}

ReferenceLevels::OwnError ReferenceLevels::discretization_error(const SceneMetrics& metrics,
                                                                const Window& window) const {
  return discretization_error(metrics, window, finest());
}

CheckResult discretization_error_check(const ReferenceLevels& levels, const SceneMetrics& metrics,
                                       const std::vector<Window>& windows, double bound,
                                       bool is_sabotaged) {
  CheckResult check;
  check.engine = kReference.title();
  check.claim = "the reference's discretization error is a tenth of the bound";
  check.metric = "grid convergence index of the finest of three steps";
  check.unit = unit_of(windows.front().quantity);
  check.formula = fmt::format(
      "Fs |x(2h) - x(h)| / (2^p - 1), h = {:.3g} s; Fs = 1.25 where the observed order confirms "
      "that of "
      "the method ({}), else 3",
      levels.finest_step(), levels.order().lowest < 2 ? "1 in contact, 2 in smooth motion" : "2");
  check.source = "Roache, J. Fluids Eng. 116 (1994) 405; velocity Verlet with steps 4h, 2h, h";
  check.tolerance = Tolerance{kOwnShare * bound, Basis::kTruncation,
                              "a tenth of the tightest bound that it serves"};
  check.note = "a smaller step for the finest level, or a scene in which folds decide less";
  double end = 0.0;
  const auto worst = [&](const Frames& finest) {
    double value = 0.0;
    for (const Window& window : windows) {
      value = larger_change(value,
                            levels.discretization_error(metrics, window, finest).study.uncertainty);
    }
    return value;
  };
  check.measured = worst(levels.finest());
  check.verdict = judge(check.measured, *check.tolerance);
  if (!is_sabotaged) return check;
  for (const Window& window : windows) {
    if (window.begin < window.end) end = std::max(end, window.end);
  }
  // One that ends early has no number at rest: only what it covers is looked at.
  const Sabotage sabotage = coarse_step(metrics.scene());
  const Frames coarse = run_sabotaged(metrics.scene(), sabotage, end);
  double measured = 0.0;
  for (const Window& window : windows) {
    if (window.end > end) continue;
    measured = larger_change(
        measured, levels.discretization_error(metrics, window, coarse).study.uncertainty);
  }
  check.sabotages.push_back(
      {sabotage.name, measured,
       std::isfinite(measured) && judge(measured, *check.tolerance) == Verdict::kFail});
  return check;
}

std::vector<std::string> own_error_columns() {
  return {"finest step [s]", "4h and 2h apart",        "2h and h apart",
          "observed order",  "grid convergence index", "a tenth of the bound"};
}

std::vector<std::string> own_error_cells(const ReferenceLevels& levels, const SceneMetrics& metrics,
                                         const Window& window, double bound) {
  const ReferenceLevels::OwnError error = levels.discretization_error(metrics, window);
  const std::string order = error.study.order ? fmt::format("{:.2f}", *error.study.order) : "-";
  return {fmt::format("{:.3g}", levels.finest_step()),
          fmt::format("{:.2g}", error.coarse),
          fmt::format("{:.2g}", error.fine),
          order + (error.study.is_confirmed ? "" : " (not confirmed)"),
          fmt::format("{:.2g}", error.study.uncertainty),
          fmt::format("{:.2g}", kOwnShare * bound)};
}

}  // namespace weft::validation
