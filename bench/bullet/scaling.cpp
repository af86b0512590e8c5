#include <chrono>
#include <fstream>
#include <memory>

#include <tbb/task_arena.h>
#include <unistd.h>

#include <weft/bridge/cloth_body.hpp>
#include <weft/bridge/soft_world.hpp>
#include <weft/mesh/cloth_grid.hpp>

#include "bench/bench.hpp"
#include "bench/result_file.hpp"
#include "bench/stopwatch.hpp"

namespace weft::bench {
namespace {

constexpr double kTimeStep = 1.0 / 60;  // [s]

/// The process's resident memory [bytes].
double resident() {
  std::ifstream file("/proc/self/statm");
  double pages = 0;
  file >> pages >> pages;
  return pages * static_cast<double>(sysconf(_SC_PAGESIZE));
}

double seconds(const std::function<void()>& call) {
  const auto start = std::chrono::steady_clock::now();
  call();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// A cloth of n x n nodes with 12 neighbors each, 1 cm apart, held along one edge.
void measure(int n, int num_steps, ResultFile& file) {
  ClothGrid grid;
  grid.nodes = {n, n};
  grid.size = {0.01 * (n - 1), 0.01 * (n - 1)};
  grid.stencil = GridStencil::k12Neighbour;
  grid.total_mass = 2e-5 * n * n;  // 200 g/m^2
  const double before = resident();
  ClothMesh mesh = make_cloth_grid(grid);
  for (int j = 0; j < n; ++j) mesh.pinned.push_back(grid_node(grid, 0, j));
  const double of_mesh = resident() - before;
  bridge::SoftWorld world({{0, -9.81, 0}, 0.1});
  btSoftBody& body =
      world.add(bridge::make_cloth_body(world.info(), mesh, {.time_step = kTimeStep}));
  const double of_body = resident() - before - of_mesh;
  (void)world.solver().attach_fast(body, mesh,
                                   {{"gravity", {}, {{"acceleration", {0.0, -9.81, 0.0}}}},
                                    {"tension", {}, {{"stiffness", {1000.0}}}}},
                                   {.may_sleep = false});
  const double first = seconds([&] { world.step(kTimeStep); });
  std::vector<double> times;
  for (int step = 0; step < num_steps; ++step) {
    times.push_back(seconds([&] { world.step(kTimeStep); }));
  }
  const double least = *std::min_element(times.begin(), times.end());
  const double nodes = static_cast<double>(n) * n;
  file.add({std::to_string(n * n), three_digits(1e3 * median(times)), three_digits(1e3 * least),
            three_digits(1e9 * least / nodes), three_digits(first), three_digits(of_body / nodes),
            three_digits((resident() - before - of_mesh - of_body) / nodes)});
}

}  // namespace

void bench_scaling(const Settings& settings) {
  ResultFile file(
      "a step of 1/60 s (2 x 3) of one cloth held along an edge with nothing to collide with, on "
      "one thread; the first "
      "step makes the factor; memory as the process grows, without the mesh",
      {"nodes", "median_ms", "least_ms", "least_ns_per_node", "first_step_s",
       "bullet_bytes_per_node", "solver_bytes_per_node"});
  tbb::task_arena arena(1);
  arena.execute([&] {
    for (const auto& [n, num_steps] :
         {std::pair{32, 200}, {100, 60}, {200, 20}, {316, 12}, {500, 8}, {1000, 4}}) {
      measure(n, num_steps, file);
      file.write(settings.folder / "scaling.csv");
    }
  });
}

}  // namespace weft::bench
