#include <weft/validation/cases/engines/seed_runs.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <span>

#include <fmt/format.h>

#include <weft/validation/cases/support/sabotage.hpp>

namespace weft::validation {
namespace seed_runs {
namespace {

constexpr int kDivisions[] = {2, 4};
constexpr double kApart = 1e-4;  // [m]

std::string seed_id(const SeedPlan& plan, int division, int seed) {
  return fmt::format("{}_seed_{}_{}", plan.id, division, seed);
}

scenes::Scene seed_scene(const SeedPlan& plan, int division, int seed) {
  scenes::Scene scene = plan.scene;
  scene.world.time_step /= division;
  scene.reference.integrator = scenes::Integrator::kVelocityVerlet;
  const double angle = 2 * std::numbers::pi * seed / kNumSeeds;
  for (scenes::Cloth& cloth : scene.cloths) {
    cloth.grid().center += kApart * Vector3<double>(std::cos(angle), 0, std::sin(angle));
  }
  return scene;
}

double mean_of(std::span<const double> values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double square_sum(std::span<const double> values, double mean) {
  double sum = 0.0;
  for (const double value : values) sum += (value - mean) * (value - mean);
  return sum;
}

SeedRuns::OwnError error_of(const std::vector<double>& values) {
  const std::span<const double> all(values);
  const std::span<const double> longer = all.first(kNumSeeds);
  const std::span<const double> shorter = all.subspan(kNumSeeds);
  const double a = mean_of(longer);
  const double b = mean_of(shorter);
  const double count = static_cast<double>(values.size());
  // Within the two groups: what the step does is counted apart.
  const double variance = (square_sum(longer, a) + square_sum(shorter, b)) / (count - 2);
  return {std::sqrt(variance), std::sqrt(variance / count), std::abs(a - b)};
}

}  // namespace
}  // namespace seed_runs

void plan_seeds(const SeedPlan& plan, EngineRuns& runs) {
  using namespace seed_runs;
  for (const int division : kDivisions) {
    for (int seed = 0; seed < kNumSeeds; ++seed) {
      runs.add({kReference.label(seed_id(plan, division, seed)), seed_scene(plan, division, seed),
                kReference.engine, kReference.precision});
    }
  }
}

SeedRuns::SeedRuns(const SeedPlan& plan, const SceneMetrics& metrics, std::vector<Window> windows,
                   const EngineRuns& runs)
    : windows_(std::move(windows)), values_(windows_.size()) {
  using namespace seed_runs;
  for (const int division : kDivisions) {
    for (int seed = 0; seed < kNumSeeds; ++seed) {
      const Frames frames = load_history(runs, seed_id(plan, division, seed), kReference).frames;
      for (std::size_t w = 0; w < windows_.size(); ++w) {
        values_[w].push_back(metrics.mean_shape_number(windows_[w].quantity, frames,
                                                       windows_[w].begin, windows_[w].end));
      }
    }
  }
}

std::size_t SeedRuns::index_of(const Window& window) const {
  using namespace seed_runs;
  const auto found = std::find_if(windows_.begin(), windows_.end(), [&](const Window& one) {
    return one.quantity == window.quantity && one.begin == window.begin && one.end == window.end;
  });
  return static_cast<std::size_t>(found - windows_.begin());
}

double SeedRuns::mean(const Window& window) const {
  using namespace seed_runs;
  return mean_of(values_.at(index_of(window)));
}

SeedRuns::OwnError SeedRuns::discretization_error(const Window& window) const {
  using namespace seed_runs;
  return error_of(values_.at(index_of(window)));
}

SeedRuns::OwnError SeedRuns::discretization_error(const Window& window, double first) const {
  using namespace seed_runs;
  std::vector<double> values = values_.at(index_of(window));
  values.front() = first;
  return error_of(values);
}

CheckResult seeds_check(const SeedRuns& seeds, const SceneMetrics& metrics, const Window& window,
                        double bound) {
  using namespace seed_runs;
  const SeedRuns::OwnError own = seeds.discretization_error(window);
  CheckResult check;
  check.engine = kReference.title();
  check.claim = "the reference's discretization error is a tenth of the bound";
  check.metric = fmt::format("of the mean {} over {} runs, {:g} to {:g} s",
                             window.quantity == Quantity::kMeanHeight ? "height" : "radius",
                             2 * kNumSeeds, window.begin, window.end);
  check.unit = "1";
  check.formula = "2 s / sqrt(n) + |mean(h/2) - mean(h/4)| / 2";
  check.source = fmt::format(
      "velocity Verlet, {} starts 0.1 mm apart, steps h/2 and h/4: one run deviates by {:.2g}, the "
      "means with both steps by {:.2g}",
      kNumSeeds, own.deviation, own.step_effect);
  check.tolerance = Tolerance{kOwnShare * bound, Basis::kStatistical,
                              "a tenth of the tightest bound that it serves"};
  check.measured = own.total();
  check.verdict = judge(check.measured, *check.tolerance);
  check.note = "more seeds, a shorter step, or a number that folds change less";
  const Sabotage sabotage = colliders_moved({0.5, 0, 0});
  const double wrong = metrics.mean_shape_number(
      window.quantity, run_sabotaged(metrics.scene(), sabotage, window.end), window.begin,
      window.end);
  const double measured = seeds.discretization_error(window, wrong).total();
  check.sabotages.push_back(
      {sabotage.name + " in one run", measured,
       std::isfinite(measured) && judge(measured, *check.tolerance) == Verdict::kFail});
  return check;
}

}  // namespace weft::validation
