#include <limits>
#include <memory>

#include <fmt/core.h>
#include <tbb/task_arena.h>

#include <weft/engines/bullet/bullet_simulator.hpp>
#include <weft/validation/metrics/rest_forces.hpp>
#include <weft/validation/motion/motion_figures.hpp>
#include <weft/validation/motion/motion_scenes.hpp>

#include "bench/bench.hpp"
#include "bench/result_file.hpp"
#include "bench/stopwatch.hpp"

namespace weft::bench {
namespace {

double epsilon() {
  return scenes::bullet_precision() == scenes::StoredPrecision::kFloat32
             ? double{std::numeric_limits<float>::epsilon()}
             : std::numeric_limits<double>::epsilon();
}

double lowest(const scenes::SceneState& state) {
  return state.cloths[0].positions.row(1).minCoeff();
}

void add_row(const scenes::Scene& given, int steps_per_second, ResultFile& file) {
  const scenes::Scene scene =
      validation::with_step(given, 1.0 / steps_per_second, given.world.duration / 2);
  const std::unique_ptr<scenes::Simulator> solver = scenes::make_bullet_weft();
  const double start = processor_time();
  const validation::MotionFrames frames = validation::frames_of(*solver, scene);
  const double per_step = (processor_time() - start) / (scene.world.duration * steps_per_second);
  const validation::RestForces forces(scene, epsilon());
  const validation::UnbalancedForces now = forces.evaluate(frames.back());
  const validation::UnbalancedForces frozen = forces.evaluate(frames.front());
  const double speed = frames.back().cloths[0].velocities.colwise().norm().maxCoeff();
  file.add({scene.name, fmt::format("1/{}", steps_per_second), three_digits(now.largest),
            three_digits(now.mean), three_digits(now.rounding_largest),
            three_digits(now.rounding_mean), fmt::format("{}", now.num_nodes),
            three_digits(1000 * speed), fmt::format("{:.4f}", lowest(frames.back())),
            three_digits(frozen.largest), three_digits(frozen.mean),
            fmt::format("{:.4f}", lowest(frames.front())), three_digits(per_step)});
}

}  // namespace

void bench_motion_rest(const Settings& settings) {
  ResultFile file(
      "scenes that have come to rest with the fast solver's default setting (nothing sleeps): "
      "forces of the laws that "
      "nothing balances, over m g, on nodes that are neither pinned nor near a collider, largest "
      "and mean; what rounding the places "
      "alone makes of it; the fastest node; the height of the lowest node, which no step may "
      "change; and the same of the start, frozen",
      {"scene", "step_s", "largest_over_mg", "mean_over_mg", "rounding_largest", "rounding_mean",
       "free_nodes", "fastest_mm_per_s", "lowest_m", "frozen_largest_over_mg",
       "frozen_mean_over_mg", "frozen_lowest_m", "mean_ms"});
  tbb::task_arena arena(1);
  arena.execute([&] {
    for (const scenes::Scene& scene :
         {validation::hammock(), validation::banner(), validation::drape_over_box(),
          validation::drape_over_ball(), validation::sheet_over_narrow_box()}) {
      for (const int steps : {60, 240}) add_row(scene, steps, file);
    }
    for (const validation::Strip& strip : validation::typical_strips()) {
      for (const int steps : {60, 240, 1000})
        add_row(validation::clamped_strip(strip), steps, file);
    }
  });
  file.write(settings.folder / "motion_rest.csv");
}

}  // namespace weft::bench
