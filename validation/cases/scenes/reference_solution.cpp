#include <weft/validation/cases/scenes/reference_solution.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace weft::validation {
namespace {

std::string time_text(const Window& window) {
  return window.begin == window.end ? fmt::format("{:g} s", window.end)
                                    : fmt::format("{:g} to {:g} s", window.begin, window.end);
}

}  // namespace

std::string metric_text(Quantity quantity) {
  switch (quantity) {
    case Quantity::kLargestDistance:
      return "largest node distance";
    case Quantity::kRmsDistance:
      return "RMS node distance / cloth size";
    case Quantity::kRigidDistance:
      return "largest distance of the rigid body";
    case Quantity::kMeanHeight:
      return "mean height / cloth size";
    case Quantity::kMeanRadius:
      return "RMS distance from the middle / cloth size";
    case Quantity::kDepth:
      break;
  }
  return "deepest node below a surface";
}

ReferenceSolution::ReferenceSolution(std::string id, const scenes::Scene& scene,
                                     std::vector<SceneBound> bounds)
    : id_(std::move(id)), scene_(scene), bounds_(std::move(bounds)) {}

std::vector<ReferenceSolution::Served> ReferenceSolution::served(Against against) const {
  std::vector<Served> list;
  for (const SceneBound& bound : bounds_) {
    if (bound.against != against) continue;
    const auto found = std::find_if(list.begin(), list.end(), [&](const Served& one) {
      return one.window.quantity == bound.quantity && one.window.begin == bound.begin &&
             one.window.end == bound.end;
    });
    if (found == list.end()) {
      list.push_back({{bound.quantity, bound.begin, bound.end}, bound.tolerance.value});
    } else {
      found->bound = std::min(found->bound, bound.tolerance.value);
    }
  }
  return list;
}

std::vector<Window> ReferenceSolution::windows(Against against) const {
  std::vector<Window> list;
  for (const Served& one : served(against)) list.push_back(one.window);
  return list;
}

LevelPlan ReferenceSolution::level_plan() const {
  LevelPlan plan{id_, scene_};
  double end = 0.0;
  for (const Window& window : windows(Against::kSolution)) end = std::max(end, window.end);
  scenes::World& world = plan.scene.world;
  const double frames = std::ceil(end / world.frame_interval - 1e-3);
  world.duration = std::min(world.duration, frames * world.frame_interval);
  return plan;
}

void ReferenceSolution::plan(EngineRuns& runs) const {
  if (!windows(Against::kSolution).empty()) plan_levels(level_plan(), runs);
  if (!windows(Against::kSeeds).empty()) plan_seeds({id_, scene_}, runs);
}

void ReferenceSolution::load(const SceneMetrics& metrics, const EngineRuns& runs) {
  if (!windows(Against::kSolution).empty()) levels_.emplace(level_plan(), runs);
  const std::vector<Window> seeded = windows(Against::kSeeds);
  if (!seeded.empty()) seeds_.emplace(SeedPlan{id_, scene_}, metrics, seeded, runs);
}

double ReferenceSolution::measured(const SceneBound& bound, const SceneMetrics& metrics,
                                   const Frames& frames, const Frames& same_step) const {
  if (bound.against == Against::kSeeds) {
    const Window window{bound.quantity, bound.begin, bound.end};
    return std::abs(metrics.mean_shape_number(bound.quantity, frames, bound.begin, bound.end) -
                    seeds_->mean(window));
  }
  const Frames& other = bound.against == Against::kSolution ? levels_->finest() : same_step;
  return metrics.largest(bound.quantity, frames, other, bound.begin, bound.end);
}

std::string ReferenceSolution::source(const SceneBound& bound) const {
  switch (bound.against) {
    case Against::kSolution:
      return fmt::format(
          "reference solver, velocity Verlet, {:.3g} s, its discretization error checked",
          levels_->finest_step());
    case Against::kSeeds:
      return fmt::format("reference solver, mean over {} runs", 2 * kNumSeeds);
    case Against::kScheme:
      break;
  }
  return bound.quantity == Quantity::kDepth ? "signed distance to the collider's surface"
                                            : "reference solver, modified Euler, same step: the "
                                              "same recurrence, whatever its error";
}

std::vector<CheckResult> ReferenceSolution::own_checks(const CaseInfo& info,
                                                       const SceneMetrics& metrics) const {
  std::vector<CheckResult> checks;
  for (const Served& one : served(Against::kSolution)) {
    checks.push_back(discretization_error_check(*levels_, metrics, {one.window}, one.bound));
    checks.back().metric +=
        fmt::format(", {}, {}", metric_text(one.window.quantity), time_text(one.window));
  }
  for (const Served& one : served(Against::kSeeds)) {
    checks.push_back(seeds_check(*seeds_, metrics, one.window, one.bound));
  }
  for (CheckResult& check : checks) check.case_id = info.id;
  return checks;
}

Table ReferenceSolution::own_table(const SceneMetrics& metrics) const {
  Table table{"The reference's discretization error, in the unit of the bound that it serves",
              {"quantity", "time"},
              {}};
  for (std::string& column : own_error_columns()) table.columns.push_back(std::move(column));
  for (const Served& one : served(Against::kSolution)) {
    std::vector<std::string> row{
        fmt::format("{} [{}]", metric_text(one.window.quantity), unit_of(one.window.quantity)),
        time_text(one.window)};
    for (std::string& cell : own_error_cells(*levels_, metrics, one.window, one.bound)) {
      row.push_back(std::move(cell));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

}  // namespace weft::validation
