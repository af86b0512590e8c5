#include "tests/scenes/catalog/scene_run.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include <gtest/gtest.h>

#include <weft/engines/engine_table.hpp>
#include <weft/validation/metrics/distance/penetration.hpp>
#include <weft/validation/metrics/distance/self_intersection.hpp>

namespace weft::scenes {
namespace {

int piercings(const SceneState& state, const std::vector<ClothMesh>& meshes) {
  int count = 0;
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    const Matrix3X<double>& x = state.cloths[i].positions;
    count += static_cast<int>(validation::self_piercings(x, meshes[i].triangles).size());
    for (std::size_t j = 0; j < i; ++j) {
      count += validation::count_piercings(x, meshes[i].triangles, state.cloths[j].positions,
                                           meshes[j].triangles);
    }
  }
  return count;
}

}  // namespace

void run_scene(const Scene& for_all, const std::function<void(const SceneState&)>& look,
               const std::function<void(const StepReport&)>& read) {
  const std::string name = for_all.engines.empty() ? "bullet_soft" : for_all.engines.front();
  const EngineInfo* engine = find_engine(name, StoredPrecision::kFloat32);
  ASSERT_NE(engine, nullptr);
  const Scene scene = with_step_of(for_all, name);
  const std::unique_ptr<Simulator> simulator = engine->make();
  simulator->load(scene);
  const World& world = scene.world;
  const auto num_steps = static_cast<int>(std::round(world.duration / world.time_step));
  const auto per_frame = static_cast<int>(std::round(world.frame_interval / world.time_step));
  for (int step = 1; step <= num_steps; ++step) {
    const StepReport report = simulator->step(world.time_step);
    ASSERT_FALSE(report.blow_up) << report.blow_up->body << ": " << report.blow_up->reason;
    read(report);
    if (step % per_frame == 0) look(simulator->state());
  }
}

SolveNumbers measure_solves(Scene scene) {
  scene.engines = {"bullet_weft"};
  SolveNumbers numbers;
  int num_steps = 0;
  int num_unsolved = 0;
  run_scene(
      scene, [](const SceneState&) {},
      [&](const StepReport& report) {
        ++num_steps;
        if (!report.solve.value().is_within_tolerance) ++num_unsolved;
        numbers.largest_error = std::max(numbers.largest_error, report.solve->error);
      });
  numbers.unsolved_share = static_cast<double>(num_unsolved) / num_steps;
  return numbers;
}

RunNumbers measure_scene(const Scene& scene) {
  std::vector<ClothMesh> meshes;
  for (const Cloth& cloth : scene.cloths) meshes.push_back(make_mesh(cloth));
  RunNumbers numbers;
  run_scene(scene, [&](const SceneState& state) {
    numbers.deepest_end = 0.0;
    for (const validation::Penetration& row : validation::penetrations(scene, state)) {
      numbers.deepest_end = std::max(numbers.deepest_end, row.surface.deepest);
    }
    numbers.deepest = std::max(numbers.deepest, numbers.deepest_end);
    numbers.piercings_end = piercings(state, meshes);
    numbers.most_piercings = std::max(numbers.most_piercings, numbers.piercings_end);
    numbers.fastest_end = 0.0;
    numbers.end.clear();
    for (const ClothState& cloth : state.cloths) {
      numbers.fastest_end =
          std::max(numbers.fastest_end, cloth.velocities.colwise().norm().maxCoeff());
      numbers.end.push_back(cloth.positions);
    }
  });
  return numbers;
}

}  // namespace weft::scenes
