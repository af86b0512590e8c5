// Tested by tests/validation/cases/engines/work_precision_test.cpp.

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <fmt/format.h>

#include <weft/scenes/catalog.hpp>
#include <weft/validation/cases/engines/work_precision.hpp>

namespace weft::validation {
namespace work_precision_runs {
namespace {

using scenes::Integrator;
using scenes::StoredPrecision;

constexpr double kFrameInterval = 0.02;  // [s]
constexpr int kIterations[] = {5, 10, 20, 40, 80};

std::string step_text(int steps_per_frame) {
  return fmt::format("1/{:.0f} s", steps_per_frame / kFrameInterval);
}

void add_series(std::vector<WorkRun>& runs, const WorkStudy& study, const EngineChoice& engine,
                const std::string& name, Integrator integrator) {
  for (const int steps : study.steps_per_frame) {
    runs.push_back({engine, name, steps, 0, integrator});
  }
}

}  // namespace
}  // namespace work_precision_runs

std::string WorkRun::label(const std::string& study) const {
  using namespace work_precision_runs;
  return fmt::format("work_{}_{}_{}_{}", engine.label(study), static_cast<int>(integrator),
                     steps_per_frame, iterations);
}

const std::vector<WorkStudy>& work_studies() {
  // Times before folds amplify every difference. Steps: the coarsest is within a factor of two of the
  // largest at which the explicit engines are stable.
  static const std::vector<WorkStudy> kStudies = {
      {"hang", 13, 1.0, {20, 40, 80}, 640, 1e-11},
      {"drape_sphere", 20, 1.0, {2, 4, 8}, 256, 1e-4},
  };
  return kStudies;
}

std::vector<WorkRun> work_runs(const WorkStudy& study, bool with_bullet) {
  using namespace work_precision_runs;
  std::vector<WorkRun> runs;
  const EngineChoice reference{"reference", StoredPrecision::kFloat64};
  if (with_bullet) {
    const EngineChoice soft{"bullet_soft", StoredPrecision::kFloat32};
    for (const int steps : study.steps_per_frame) {
      for (const int iterations : kIterations) {
        const std::string name = soft.title() + ", " + step_text(steps);
        runs.push_back({soft, name, steps, iterations, Integrator::kModifiedEuler});
      }
    }
    // Stable at any step: those that its users take, a frame and parts of it.
    const EngineChoice fast{"bullet_weft", StoredPrecision::kFloat32};
    for (const int steps : {1, 3, 9}) {
      runs.push_back({fast, fast.title(), steps, 0, Integrator::kModifiedEuler});
    }
    for (const char* name : {"bullet_forces", "bullet_deformable", "bullet_deformable_implicit"}) {
      const EngineChoice engine{name, StoredPrecision::kFloat32};
      add_series(runs, study, engine, engine.title(), Integrator::kModifiedEuler);
    }
  }
  add_series(runs, study, reference, "reference, modified Euler", Integrator::kModifiedEuler);
  add_series(runs, study, reference, "reference, velocity Verlet", Integrator::kVelocityVerlet);
  add_series(runs, study, reference, "reference, Runge-Kutta 4", Integrator::kRungeKutta4);
  return runs;
}

std::vector<WorkRun> converged_runs(const WorkStudy& study) {
  using namespace work_precision_runs;
  std::vector<WorkRun> runs;
  const EngineChoice reference{"reference", StoredPrecision::kFloat64};
  for (const int divisor : {4, 2, 1}) {
    runs.push_back({reference, "converged", study.finest_steps_per_frame / divisor, 0,
                    Integrator::kRungeKutta4});
  }
  return runs;
}

scenes::Scene work_scene(const WorkStudy& study, const WorkRun& run) {
  using namespace work_precision_runs;
  scenes::Scene scene = scenes::load_scene(study.scene);
  scene.world.duration = study.duration;
  scene.world.frame_interval = kFrameInterval;
  scene.world.time_step = kFrameInterval / run.steps_per_frame;
  scene.cloths.front().grid().nodes = {study.nodes, study.nodes};
  if (run.iterations > 0) scene.bullet.position_iterations = run.iterations;
  scene.reference.integrator = run.integrator;
  return scenes::with_bullets_time_step(std::move(scene));
}

std::vector<std::size_t> pareto_front(const std::vector<double>& work,
                                      const std::vector<double>& error) {
  using namespace work_precision_runs;
  std::vector<std::size_t> order(work.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::erase_if(order, [&](std::size_t i) {
    return !(std::isfinite(work[i]) && work[i] > 0 && std::isfinite(error[i]) && error[i] > 0);
  });
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return work[a] != work[b] ? work[a] < work[b] : error[a] < error[b];
  });
  double best = std::numeric_limits<double>::infinity();
  std::erase_if(order, [&](std::size_t i) {
    if (error[i] >= best) return true;
    best = error[i];
    return false;
  });
  return order;
}

}  // namespace weft::validation
