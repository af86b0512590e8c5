#include <weft/validation/cases/scenes/scene_section.hpp>

#include <cmath>
#include <utility>

#include <fmt/format.h>

#include <weft/scenes/format/scene_file.hpp>
#include <weft/validation/metrics/distance/penetration.hpp>
#include <weft/validation/metrics/settling.hpp>
#include <weft/validation/metrics/strain.hpp>

namespace weft::validation {
namespace {

using FrameValue = double (*)(const SceneMetrics&, const scenes::SceneState&);

Series series_of(const SceneMetrics& metrics, const History& history, FrameValue value) {
  Series series{history.engine.title(), {}, {}};
  for (const scenes::SceneState& frame : history.frames) {
    series.x.push_back(frame.time);
    series.y.push_back(value(metrics, frame));
  }
  return series;
}

Plot plot_each(const SceneMetrics& metrics, const std::vector<History>& histories,
               std::string title, std::string y_label, FrameValue value) {
  Plot plot{std::move(title), "time [s]", std::move(y_label), false, false, {}};
  for (const History& history : histories) {
    if (!history.frames.empty()) plot.series.push_back(series_of(metrics, history, value));
  }
  return plot;
}

Plot plot_distance(const SceneMetrics& metrics, const std::vector<History>& histories,
                   Quantity quantity, std::string title, std::string y_label) {
  Plot plot{std::move(title), "time [s]", std::move(y_label), false, true, {}};
  const Frames& reference = histories.back().frames;
  for (const History& history : histories) {
    if (&history == &histories.back()) break;
    Series series{history.engine.title(), {}, {}};
    for (std::size_t f = 1; f < std::min(history.frames.size(), reference.size()); ++f) {
      series.x.push_back(history.frames[f].time);
      series.y.push_back(metrics.at(quantity, history.frames[f], reference[f]));
    }
    if (!series.x.empty()) plot.series.push_back(std::move(series));
  }
  return plot;
}

double kinetic(const SceneMetrics& metrics, const scenes::SceneState& frame) {
  return metrics.energy().evaluate(frame).kinetic();
}

double total(const SceneMetrics& metrics, const scenes::SceneState& frame) {
  return metrics.energy().evaluate(frame).total();
}

double largest_strain_percent(const SceneMetrics& metrics, const scenes::SceneState& frame) {
  return 100 * metrics.stretch_strains(frame).maxCoeff();
}

double depth_millimetres(const SceneMetrics& metrics, const scenes::SceneState& frame) {
  return 1000 * metrics.at(Quantity::kDepth, frame, frame);
}

std::string settling_text(const SceneMetrics& metrics, const History& history) {
  std::vector<double> times;
  std::vector<double> values;
  for (const scenes::SceneState& frame : history.frames) {
    times.push_back(frame.time);
    values.push_back(kinetic(metrics, frame) / metrics.energy().mass());
  }
  const Settling result = settling(times, values);
  return result.time ? fmt::format("{:.2f}", *result.time) : std::string("not within the run");
}

std::vector<std::string> table_row(const SceneMetrics& metrics, const History& history,
                                   const Frames& reference) {
  if (history.frames.empty()) return {history.engine.title(), history.failure};
  const scenes::SceneState& last = history.frames.back();
  const bool same_end = !reference.empty() && history.frames.size() == reference.size();
  const auto percent = [](double ratio) { return fmt::format("{:.3g}", 100 * ratio); };
  std::vector<std::string> row{history.engine.title()};
  if (same_end) {
    const SceneMetrics::SurfaceGap gap = metrics.surface_gap(last, reference.back());
    row.push_back(percent(metrics.at(Quantity::kRmsDistance, last, reference.back())));
    row.push_back(percent(metrics.aligned_rms(last, reference.back())));
    row.push_back(percent(gap.percentile_95));
    row.push_back(percent(gap.largest));
  } else {
    row.insert(row.end(), 4, "-");
  }
  const StrainStatistics strain = strain_statistics(metrics.stretch_strains(last));
  row.push_back(percent(strain.percentile_99));
  row.push_back(percent(strain.maximum));
  double deepest = 0;
  for (const scenes::SceneState& frame : history.frames) {
    deepest = std::max(deepest, depth_millimetres(metrics, frame));
  }
  row.push_back(fmt::format("{:.3g}", deepest));
  row.push_back(settling_text(metrics, history));
  row.push_back(history.blow_up
                    ? fmt::format("step {}, node {}", history.blow_up->step, history.blow_up->node)
                    : std::string("no"));
  row.push_back(history.content_hash.substr(0, 12));
  return row;
}

Table engine_table(const SceneMetrics& metrics, const std::vector<History>& histories) {
  Table table;
  table.title = fmt::format("At the end of the run ({:g} s); distances to the reference",
                            metrics.scene().world.duration);
  table.columns = {"engine",
                   "RMS [% of cloth size]",
                   "RMS, aligned [%]",
                   "surface distance, 95th percentile [%]",
                   "surface distance, largest [%]",
                   "strain, 99th percentile [%]",
                   "strain, largest [%]",
                   "deepest penetration of the run [mm]",
                   "at rest after [s]",
                   "blew up",
                   "content hash"};
  for (const History& history : histories) {
    table.rows.push_back(table_row(metrics, history, histories.back().frames));
    table.rows.back().resize(table.columns.size());
  }
  return table;
}

}  // namespace

Section scene_section(const SceneMetrics& metrics, const std::vector<History>& histories,
                      bool pictures) {
  Section section;
  section.id = metrics.scene().name;
  section.summary = metrics.scene().summary;
  section.scene_text = scenes::write_scene(metrics.scene());
  section.tables.push_back(engine_table(metrics, histories));
  if (histories.size() > 1) {
    section.plots.push_back(plot_distance(metrics, histories, Quantity::kLargestDistance,
                                          "Largest node distance to the reference",
                                          "distance [m]"));
    section.plots.push_back(plot_distance(metrics, histories, Quantity::kRmsDistance,
                                          "RMS node distance to the reference",
                                          "distance / cloth size [1]"));
  }
  section.plots.push_back(plot_each(metrics, histories, "Kinetic energy", "energy [J]", &kinetic));
  section.plots.push_back(plot_each(metrics, histories, "Total energy", "energy [J]", &total));
  section.plots.push_back(plot_each(metrics, histories, "Largest strain of a structural spring",
                                    "strain [%]", &largest_strain_percent));
  if (!metrics.scene().colliders.empty()) {
    section.plots.push_back(plot_each(metrics, histories, "Deepest node below a surface",
                                      "depth [mm]", &depth_millimetres));
  }
  if (pictures) section.distance_views = scene_distance_views(metrics, histories);
  if (pictures)
    section.picture_rows = scene_pictures(metrics, histories, !section.distance_views.empty());
  return section;
}

}  // namespace weft::validation
