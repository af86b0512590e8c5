#include <weft/validation/cases/engines/work_precision.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include <fmt/format.h>

#include <weft/engines/engine_table.hpp>
#include <weft/validation/cases/scenes/scene_cases.hpp>
#include <weft/validation/cases/scenes/scene_metrics.hpp>
#include <weft/validation/cases/support/sabotage.hpp>

namespace weft::validation {
namespace work_precision {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// RMS over nodes and frames of the distance between two runs [m]; infinite if one ends before.
double rms_distance(const SceneMetrics& metrics, const Frames& frames, const Frames& reference) {
  if (reference.size() < 2 || frames.size() != reference.size()) return kInfinity;
  double sum = 0.0;
  for (std::size_t f = 1; f < frames.size(); ++f) {
    const double rms =
        metrics.at(Quantity::kRmsDistance, frames[f], reference[f]) * metrics.cloth_size();
    sum += rms * rms;
  }
  return std::sqrt(sum / static_cast<double>(frames.size() - 1));
}

Frames load_frames(const EngineRuns::Outcome& outcome) {
  Frames frames;
  if (outcome.exit_code != 0) return frames;  // a run that blew up has no precision
  const scenes::RecordingReader reader(outcome.recording);
  for (int frame = 0; frame < reader.num_frames(); ++frame) frames.push_back(reader.frame(frame));
  return frames;
}

/// The finest run, with the error that its two coarser ones tell of.
struct Converged {
  Frames frames;
  double difference = kInfinity;  ///< [m] RMS between the two finest levels
  double order = 0.0;             ///< observed, of three levels that halve the step
  double error = kInfinity;       ///< [m] grid convergence index of the finest level
};

Converged converged_reference(const WorkStudy& study, const SceneMetrics& metrics,
                              const EngineRuns& runs) {
  std::vector<Frames> levels;
  for (const WorkRun& run : converged_runs(study)) {
    levels.push_back(load_frames(runs.outcome(run.label(study.scene))));
  }
  Converged result;
  const double coarse = rms_distance(metrics, levels[0], levels[1]);
  result.difference = rms_distance(metrics, levels[1], levels[2]);
  result.order = std::log2(coarse / result.difference);
  // Roache's index with the factor for three levels. Contact makes the observed order uneven: a high one
  // is not believed beyond the scheme's, nor a low one to less than a half.
  const double believed = std::clamp(std::isfinite(result.order) ? result.order : 0.5, 0.5, 4.0);
  result.error = 1.25 * result.difference / (std::pow(2.0, believed) - 1.0);
  result.frames = std::move(levels[2]);
  return result;
}

CheckResult check_converged(const CaseInfo& info, const WorkStudy& study,
                            const SceneMetrics& metrics, const Converged& converged) {
  CheckResult check;
  check.case_id = info.id;
  check.engine = "reference";
  check.claim = fmt::format("The reference that {} is held against is converged", study.scene);
  check.metric =
      fmt::format("grid convergence index, RMS over nodes and frames to {:g} s", study.duration);
  check.unit = "m";
  check.formula = "1.25 |x(2h) - x(h)| / (2^p - 1), p observed, between 0.5 and 4";
  check.source = "Roache, J. Fluids Eng. 116 (1994) 405; Runge-Kutta 4 with steps 4h, 2h, h";
  check.measured = converged.error;
  check.tolerance =
      Tolerance{study.allowed_error, Basis::kTruncation,
                "a third of the smallest distance in the diagram, or less: the places of the "
                "engines cannot change"};
  check.verdict = judge(check.measured, *check.tolerance);
  check.note = "the levels differ too much: a smaller step for the finest one";
  const WorkRun coarse = converged_runs(study).front();
  const Frames wrong =
      run_sabotaged(work_scene(study, coarse), stiffness_scaled(1.01), study.duration);
  const double off = rms_distance(metrics, wrong, converged.frames);
  check.sabotages.push_back({"spring constant +1 % in one level", off,
                             std::isfinite(off) && judge(off, *check.tolerance) == Verdict::kFail});
  return check;
}

struct WorkPrecisionPoint {
  WorkRun run;
  double work = std::nan("");   ///< [ms] of wall time per simulated second
  double error = std::nan("");  ///< [m]
};

std::vector<WorkPrecisionPoint> points_of(const WorkStudy& study, const SceneMetrics& metrics,
                                          const Frames& reference, const CaseOptions& options,
                                          const EngineRuns& runs) {
  std::vector<WorkPrecisionPoint> points;
  for (const WorkRun& run : work_runs(study, options.bullet)) {
    const EngineRuns::Outcome& outcome = runs.outcome(run.label(study.scene));
    WorkPrecisionPoint point{run};
    if (outcome.engine_seconds) point.work = 1e3 * *outcome.engine_seconds / study.duration;
    point.error = rms_distance(metrics, load_frames(outcome), reference);
    points.push_back(std::move(point));
  }
  return points;
}

Series series_of(const std::string& name, std::vector<std::pair<double, double>> values) {
  std::sort(values.begin(), values.end());  // a line from cheap to dear
  Series series{name, {}, {}};
  for (const auto& [x, y] : values) {
    series.x.push_back(x);
    series.y.push_back(y);
  }
  return series;
}

Plot work_plot(const WorkStudy& study, const std::vector<WorkPrecisionPoint>& points,
               const Converged& converged) {
  Plot plot{fmt::format("{}, {} x {} nodes: precision against work", study.scene, study.nodes,
                        study.nodes),
            "wall time per simulated second [ms]",
            "RMS distance [mm]",
            true,
            true,
            {}};
  std::vector<std::string> names;
  std::map<std::string, std::vector<std::pair<double, double>>> series;
  std::vector<double> work;
  std::vector<double> error;
  for (const WorkPrecisionPoint& point : points) {
    work.push_back(point.work);
    error.push_back(1e3 * point.error);
    if (!std::isfinite(point.error) || !std::isfinite(point.work)) continue;
    if (series[point.run.series].empty()) names.push_back(point.run.series);
    series[point.run.series].emplace_back(point.work, 1e3 * point.error);
  }
  for (const std::string& name : names) plot.series.push_back(series_of(name, series[name]));
  std::vector<std::pair<double, double>> front;
  for (const std::size_t i : pareto_front(work, error)) front.emplace_back(work[i], error[i]);
  if (front.empty()) return plot;
  plot.series.push_back(series_of("Pareto front", front));
  // Far below every point it would only press them together; the table has it.
  if (1e3 * converged.error < 0.01 * front.back().second) return plot;
  const double dearest = front.back().first;
  plot.series.push_back({"error of the converged reference itself",
                         {front.front().first, dearest},
                         {1e3 * converged.error, 1e3 * converged.error}});
  return plot;
}

Table work_table(const WorkStudy& study, const std::vector<WorkPrecisionPoint>& points) {
  Table table;
  table.title = fmt::format("{}: every run", study.scene);
  table.columns = {"engine",     "precision",   "integrator",        "time step [s]",
                   "iterations", "work [ms/s]", "RMS distance [mm]", "on the Pareto front"};
  std::vector<double> work;
  std::vector<double> error;
  for (const WorkPrecisionPoint& point : points) {
    work.push_back(point.work);
    error.push_back(point.error);
  }
  const std::vector<std::size_t> front = pareto_front(work, error);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const WorkPrecisionPoint& point = points[i];
    const bool is_reference = point.run.engine.engine == "reference";
    const std::size_t comma = point.run.series.find(", ");
    table.rows.push_back(
        {point.run.engine.engine, std::string(scenes::to_string(point.run.engine.precision)),
         is_reference ? point.run.series.substr(comma + 2) : std::string("the engine's own"),
         fmt::format("{:g}", work_scene(study, point.run).world.time_step),
         point.run.iterations > 0 ? std::to_string(point.run.iterations) : std::string("-"),
         fmt::format("{:.4g}", point.work),
         std::isfinite(point.error) ? fmt::format("{:.4g}", 1e3 * point.error)
                                    : std::string("blew up"),
         std::find(front.begin(), front.end(), i) != front.end() ? "yes" : "no"});
  }
  return table;
}

Table converged_table(const WorkStudy& study, const Converged& converged) {
  return {fmt::format("The converged reference of {}", study.scene),
          {"finest step [s]", "levels 2h and h apart, RMS [mm]", "observed order",
           "grid convergence index [mm]"},
          {{fmt::format("{:g}", work_scene(study, converged_runs(study).back()).world.time_step),
            fmt::format("{:.3g}", 1e3 * converged.difference),
            fmt::format("{:.2f}", converged.order), fmt::format("{:.3g}", 1e3 * converged.error)}}};
}

}  // namespace
}  // namespace work_precision

void plan_work_precision(const CaseInfo&, const CaseOptions& options, EngineRuns& runs) {
  using namespace work_precision;
  for (const WorkStudy& study : work_studies()) {
    for (const auto& list : {work_runs(study, options.bullet), converged_runs(study)}) {
      for (const WorkRun& run : list) {
        runs.add({run.label(study.scene), work_scene(study, run), run.engine.engine,
                  run.engine.precision});
      }
    }
  }
}

void evaluate_work_precision(const CaseInfo& info, const CaseOptions& options,
                             const EngineRuns& runs, Report& report) {
  using namespace work_precision;
  Section section{std::string(info.id), std::string(info.summary), {}, {}, {}, ""};
  for (const WorkStudy& study : work_studies()) {
    const SceneMetrics metrics(work_scene(study, converged_runs(study).back()));
    const Converged converged = converged_reference(study, metrics, runs);
    report.checks.push_back(check_converged(info, study, metrics, converged));
    const std::vector<WorkPrecisionPoint> points =
        points_of(study, metrics, converged.frames, options, runs);
    section.plots.push_back(work_plot(study, points, converged));
    section.tables.push_back(converged_table(study, converged));
    section.tables.push_back(work_table(study, points));
  }
  report.sections.push_back(std::move(section));
}

}  // namespace weft::validation
