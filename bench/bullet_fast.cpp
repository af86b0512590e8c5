#include <algorithm>
#include <ctime>
#include <functional>
#include <memory>

#include <BulletCollision/CollisionShapes/btSphereShape.h>
#include <BulletSoftBody/btSoftBodyHelpers.h>
#include <tbb/task_arena.h>

#include <weft/bridge/cloth_body.hpp>
#include <weft/bridge/node_state.hpp>
#include <weft/bridge/soft_world.hpp>
#include <weft/custom_forces/core/cloth_grid.hpp>

#include "bench/bench.hpp"
#include "bench/result_file.hpp"
#include "bench/stopwatch.hpp"

namespace weft::bench {
namespace {

constexpr double kStiffness = 1000.0;  // [N/m]

/// A cloth of 1 kg in a world: hung up at two corners, or above a fixed sphere.
struct Workload {
  std::string name;
  int nodes;    ///< along an edge
  double size;  ///< [m] of an edge
  bool is_hung;
  double time_step;  ///< [s]
  int num_steps;
  int reference_steps;  ///< of explicit integration per step
};

ClothMesh mesh_of(const Workload& workload) {
  ClothGrid grid;
  grid.nodes = {workload.nodes, workload.nodes};
  grid.size = {workload.size, workload.size};
  grid.center = {0, workload.is_hung ? 0.0 : 2.2, 0};
  grid.stencil = workload.is_hung ? GridStencil::k12Neighbour : GridStencil::k24Neighbour;
  grid.lumping = MassLumping::kUniform;
  ClothMesh mesh = make_cloth_grid(grid);
  if (workload.is_hung) mesh.pinned = {0, workload.nodes - 1};
  return mesh;
}

class Run {
 public:
  /// Bullet's links with the stiffness that so many iterations make of them, the laws of the same
  /// springs, or the fast solver.
  static std::unique_ptr<Run> links(const Workload& workload, int iterations, bool reorders,
                                    int substeps = 1) {
    auto run = std::make_unique<Run>(workload, iterations, true, substeps);
    // Changes the order of links only: Bullet reads nothing else from the array.
    if (reorders) btSoftBodyHelpers::ReoptimizeLinkOrder(run->body_);
    run->world_.solver().attach(*run->body_, run->mesh_, {run->gravity_});
    return run;
  }
  static std::unique_ptr<Run> laws(const Workload& workload, int substeps) {
    auto run = std::make_unique<Run>(workload, 1, false, substeps);
    run->world_.solver().attach(*run->body_, run->mesh_, {run->gravity_, run->tension_});
    return run;
  }
  static std::unique_ptr<Run> fast(const Workload& workload, const bridge::FastSettings& settings) {
    auto run = std::make_unique<Run>(workload, 1, false, 1);
    (void)run->world_.solver().attach_fast(*run->body_, run->mesh_, {run->gravity_, run->tension_},
                                           settings);
    return run;
  }

  Run(const Workload& workload, int iterations, bool has_links, int substeps)
      : mesh_(mesh_of(workload)), substeps_(substeps), world_({{0, -9.81, 0}, 0.1}) {
    bridge::ClothSettings settings{.collision_margin = 0.01,
                                   .friction = 0.3,
                                   .position_iterations = iterations,
                                   .time_step = workload.time_step / substeps};
    if (has_links) settings.links.push_back({{}, kStiffness});
    body_ = &world_.add(bridge::make_cloth_body(world_.info(), mesh_, settings));
    if (workload.is_hung) return;
    auto sphere = std::make_shared<btSphereShape>(btScalar(2));
    btRigidBody::btRigidBodyConstructionInfo info(0, nullptr, sphere.get());
    world_.add(std::make_unique<btRigidBody>(info), sphere);
  }

  /// Simulates this much time [s].
  void step(double time) {
    for (int s = 0; s < substeps_; ++s) world_.step(time / substeps_);
    Matrix3X<btScalar> x;
    Matrix3X<btScalar> v;
    bridge::read_nodes(*body_, x, v);
    positions_ = x.cast<double>();
  }
  [[nodiscard]] const Matrix3X<double>& positions() const { return positions_; }
  /// Largest and mean change of length of the structural springs [1].
  [[nodiscard]] std::pair<double, double> stretch() const {
    const Edges edges = mesh_.edges_of({"stretch"});
    const VectorX<double> now = edge_lengths(positions_, edges);
    const VectorX<double> rest = edge_lengths(mesh_.rest_positions, edges);
    const VectorX<double> change = (now.array() / rest.array() - 1).abs();
    return {change.maxCoeff(), change.mean()};
  }

 private:
  forces::LawSpecification gravity_{"gravity", {}, {{"acceleration", {0.0, -9.81, 0.0}}}};
  forces::LawSpecification tension_{"tension", {}, {{"stiffness", {kStiffness}}}};
  ClothMesh mesh_;
  int substeps_;
  bridge::SoftWorld world_;
  btSoftBody* body_;
  Matrix3X<double> positions_;
};

/// Of this thread, which others on the machine do not add to [ms].
double processor_time() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

struct Contender {
  std::string solver;
  std::string settings;
  std::unique_ptr<Run> run;
  int num_steps = 1;               ///< of the workload that one of its own is long
  std::vector<double> times = {};  ///< [ms] for a step of the workload
  double squared_error = 0.0;      ///< [m^2] sum over its steps
  double last_error = 0.0;         ///< [m]
};

std::vector<Contender> contenders(const Workload& workload) {
  std::vector<Contender> list;
  for (const int iterations : {10, 20, 50}) {
    list.push_back({"bullet", std::to_string(iterations), Run::links(workload, iterations, false)});
  }
  for (const int iterations : {10, 50}) {
    list.push_back(
        {"bullet_reordered", std::to_string(iterations), Run::links(workload, iterations, true)});
  }
  for (const int iterations : {10, 50}) {
    list.push_back({"bullet_substeps", std::to_string(iterations) + " in 4 steps",
                    Run::links(workload, iterations, false, 4)});
  }
  list.push_back({"bullet_forces", std::to_string(workload.reference_steps / 2) + " steps",
                  Run::laws(workload, workload.reference_steps / 2)});
  struct Effort {
    int rounds, iterations, num_steps;
  };
  for (const Effort& e : {Effort{1, 1, 1},
                          {1, 2, 1},
                          {1, 4, 1},
                          {2, 2, 1},
                          {2, 4, 1},
                          {2, 8, 1},
                          {4, 8, 1},
                          {8, 16, 1},
                          {1, 2, 2},
                          {2, 4, 2},
                          {1, 2, 4},
                          {2, 4, 4}}) {
    for (const bool is_second_order : {true, false}) {
      std::string name = std::to_string(e.rounds) + "x" + std::to_string(e.iterations);
      if (e.num_steps > 1) name += " each " + std::to_string(e.num_steps) + " steps";
      list.push_back({is_second_order ? "weft" : "weft_euler", name,
                      Run::fast(workload, {.effort = {e.rounds, e.iterations},
                                           .is_second_order = is_second_order,
                                           .may_sleep = false}),
                      e.num_steps});
    }
  }
  return list;
}

void measure(const Workload& workload, ResultFile& file) {
  std::vector<Contender> list = contenders(workload);
  const auto reference = Run::laws(workload, workload.reference_steps);
  tbb::task_arena arena(1);
  arena.execute([&] {
    for (int step = 1; step <= workload.num_steps; ++step) {
      reference->step(workload.time_step);
      for (Contender& c : list) {
        if (step % c.num_steps != 0) continue;
        const double start = processor_time();
        c.run->step(c.num_steps * workload.time_step);
        c.times.push_back((processor_time() - start) / c.num_steps);
        c.last_error = std::sqrt((c.run->positions() - reference->positions()).squaredNorm() /
                                 static_cast<double>(reference->positions().cols()));
        c.squared_error += c.last_error * c.last_error;
      }
    }
  });
  const auto is_bullet_50 = [](const Contender& c) {
    return c.solver == "bullet" && c.settings == "50";
  };
  const double bullet = median(std::find_if(list.begin(), list.end(), is_bullet_50)->times);
  for (Contender& c : list) {
    const auto [largest, mean] = c.run->stretch();
    const double time = median(c.times);
    const double error = std::sqrt(c.squared_error / static_cast<double>(c.times.size()));
    file.add({workload.name, c.solver, c.settings, three_digits(time), three_digits(bullet / time),
              three_digits(error), three_digits(c.last_error), three_digits(100 * largest),
              three_digits(100 * mean)});
  }
}

}  // namespace

void bench_fast(const Settings& settings) {
  const Workload workloads[] = {{"hang_50", 50, 1, true, 1.0 / 60, 120, 128},
                                {"classic", 50, 7, false, 1.0 / 100, 200, 100},
                                {"hang_100", 100, 1, true, 1.0 / 60, 40, 256},
                                {"hang_200", 200, 1, true, 1.0 / 60, 12, 512}};
  ResultFile file(
      "work and precision: processor time for one step of the workload (1/60 s; classic: 1/100 s) "
      "on "
      "one thread, and distance to explicit integration of the same springs (1000 N/m) in small "
      "steps, "
      "RMS over nodes and steps",
      {"workload", "solver", "settings", "median_ms", "times_faster_than_bullet_50", "rms_error_m",
       "last_error_m", "max_stretch_percent", "mean_stretch_percent"});
  for (const Workload& workload : workloads) {
    measure(workload, file);
    file.write(settings.folder / (sizeof(btScalar) == 4 ? "fast_float32.csv" : "fast_float64.csv"));
  }
}

}  // namespace weft::bench
