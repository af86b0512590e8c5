#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include <tbb/task_arena.h>

#include <weft/bridge/cloth_body.hpp>
#include <weft/bridge/soft_world.hpp>
#include <weft/mesh/cloth_grid.hpp>

#include "bench/bench.hpp"
#include "bench/result_file.hpp"
#include "bench/stopwatch.hpp"

namespace weft::bench {
namespace {

constexpr double kTimeStep = 1.0 / 60;  // [s]
constexpr int kSteps = 120;

/// A sheet of 1 m on two corners, that swings down from the horizontal.
struct Sheet {
  bridge::SoftWorld world{bridge::SoftWorldSettings{}};

  Sheet(int n, double stiffness, bool meets_itself) {
    ClothGrid grid;
    grid.nodes = {n, n};
    grid.total_mass = 0.25;
    ClothMesh mesh = make_cloth_grid(grid);
    mesh.pinned = {grid_node(grid, 0, 0), grid_node(grid, -1, 0)};
    const double thickness = 0.5 / (n - 1);  // half an edge
    btSoftBody& body = world.add(bridge::make_cloth_body(
        world.info(), mesh, {.collision_margin = thickness / 2, .time_step = kTimeStep}));
    (void)world.solver().attach_fast(body, mesh,
                                     {{"gravity", {}, {{"acceleration", {0.0, -9.81, 0.0}}}},
                                      {"tension", {}, {{"stiffness", {stiffness}}}},
                                      {"velocity_damping", {}, {{"rate", {0.5}}}}},
                                     {.may_sleep = false});
    if (meets_itself)
      world.solver().set_cloth_contact(body, {.with_itself = true, .self_thickness = thickness});
  }
};

/// Both in turns, step by step.
void measure(int n, double stiffness, int num_rounds, ResultFile& file) {
  std::vector<double> alone_ms;
  std::vector<double> with_itself_ms;
  for (int round = 0; round < num_rounds; ++round) {
    Sheet alone(n, stiffness, false);
    Sheet with_itself(n, stiffness, true);
    for (int step = 0; step < kSteps; ++step) {
      alone_ms.push_back(processor_time([&] { alone.world.step(kTimeStep); }));
      with_itself_ms.push_back(processor_time([&] { with_itself.world.step(kTimeStep); }));
    }
  }
  const double alone = median(alone_ms);
  const double with_itself = median(with_itself_ms);
  file.add({std::to_string(n * n), three_digits(stiffness), three_digits(alone),
            three_digits(with_itself), three_digits(1 - alone / with_itself)});
}

}  // namespace

void bench_self_contact(const Settings& settings) {
  ResultFile file(
      "sheets of 1 m on two corners that swing, and meet themselves nowhere: a step of 1/60 s "
      "without contact of the cloth with itself and with it (thickness: half an edge), one thread, "
      "processor time, medians of 2 s, and what share of the step that contact is",
      {"nodes", "stiffness_N_per_m", "alone_ms", "with_itself_ms", "share_of_step"});
  tbb::task_arena arena(1);
  arena.execute([&] {
    const int num_rounds = std::max(1, settings.num_rounds / 8);
    for (const int n : {20, 50, 100}) {
      for (const double stiffness : {1e3, 1e5}) measure(n, stiffness, num_rounds, file);
    }
  });
  file.write(settings.folder / "self_contact.csv");
}

}  // namespace weft::bench
