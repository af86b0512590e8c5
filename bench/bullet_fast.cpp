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
  int reference_steps;  ///< of explicit integration per step; 0: too slow to be run here
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
  static std::unique_ptr<Run> links(const Workload& workload, int iterations, bool reorders) {
    auto run = std::make_unique<Run>(workload, iterations, true);
    // Changes the order of links only: Bullet reads nothing else from the array.
    if (reorders) btSoftBodyHelpers::ReoptimizeLinkOrder(run->body_);
    run->world_.solver().attach(*run->body_, run->mesh_, {run->gravity_});
    return run;
  }
  static std::unique_ptr<Run> laws(const Workload& workload) {
    auto run = std::make_unique<Run>(workload, 1, false);
    run->world_.solver().attach(*run->body_, run->mesh_, {run->gravity_, run->tension_});
    run->substeps_ = workload.reference_steps;
    return run;
  }
  static std::unique_ptr<Run> fast(const Workload& workload, const bridge::FastSettings& settings) {
    auto run = std::make_unique<Run>(workload, 1, false);
    (void)run->world_.solver().attach_fast(*run->body_, run->mesh_, {run->gravity_, run->tension_},
                                           settings);
    return run;
  }

  Run(const Workload& workload, int iterations, bool has_links)
      : mesh_(mesh_of(workload)), time_step_(workload.time_step), world_({{0, -9.81, 0}, 0.1}) {
    bridge::ClothSettings settings{.collision_margin = 0.01,
                                   .friction = 0.3,
                                   .position_iterations = iterations,
                                   .time_step = time_step_};
    if (has_links) settings.links.push_back({{}, kStiffness});
    body_ = &world_.add(bridge::make_cloth_body(world_.info(), mesh_, settings));
    if (workload.is_hung) return;
    auto sphere = std::make_shared<btSphereShape>(btScalar(2));
    btRigidBody::btRigidBodyConstructionInfo info(0, nullptr, sphere.get());
    world_.add(std::make_unique<btRigidBody>(info), sphere);
  }

  void step() {
    for (int s = 0; s < substeps_; ++s) world_.step(time_step_ / substeps_);
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
  double time_step_;
  int substeps_ = 1;
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
  std::vector<double> times = {};  ///< [ms] of each step
  double squared_error = 0.0;      ///< [m^2] sum over steps
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
  for (const auto& [rounds, iterations] :
       {std::pair{1, 1}, {1, 2}, {1, 3}, {2, 2}, {2, 3}, {2, 6}}) {
    const bridge::FastSettings settings{.effort = {rounds, iterations}};
    list.push_back({"weft", std::to_string(rounds) + "x" + std::to_string(iterations),
                    Run::fast(workload, settings)});
  }
  list.push_back(
      {"weft_euler", "2x3", Run::fast(workload, {.effort = {2, 3}, .is_second_order = false})});
  return list;
}

void measure(const Workload& workload, ResultFile& file) {
  std::vector<Contender> list = contenders(workload);
  std::unique_ptr<Run> reference;
  if (workload.reference_steps > 0) reference = Run::laws(workload);
  std::vector<double> reference_times;
  tbb::task_arena arena(1);
  arena.execute([&] {
    for (int step = 0; step < workload.num_steps; ++step) {
      if (reference) {
        const double start = processor_time();
        reference->step();
        reference_times.push_back(processor_time() - start);
      }
      for (Contender& c : list) {
        const double start = processor_time();
        c.run->step();
        c.times.push_back(processor_time() - start);
        if (!reference) continue;
        c.last_error = std::sqrt((c.run->positions() - reference->positions()).squaredNorm() /
                                 static_cast<double>(reference->positions().cols()));
        c.squared_error += c.last_error * c.last_error;
      }
    }
  });
  const double bullet = median(list.front().times);
  const auto error = [&](double value) { return reference ? three_digits(value) : std::string(); };
  if (reference) {
    const auto [largest, mean] = reference->stretch();
    const double time = median(reference_times);
    file.add({workload.name, "bullet_forces", std::to_string(workload.reference_steps),
              three_digits(time), three_digits(time / bullet), "", "", three_digits(100 * largest),
              three_digits(100 * mean)});
  }
  for (Contender& c : list) {
    const auto [largest, mean] = c.run->stretch();
    const double time = median(c.times);
    file.add({workload.name, c.solver, c.settings, three_digits(time), three_digits(time / bullet),
              error(std::sqrt(c.squared_error / workload.num_steps)), error(c.last_error),
              three_digits(100 * largest), three_digits(100 * mean)});
  }
}

}  // namespace

void bench_fast(const Settings& settings) {
  const Workload workloads[] = {{"hang_50", 50, 1, true, 1.0 / 60, 120, 128},
                                {"hang_100", 100, 1, true, 1.0 / 60, 40, 256},
                                {"classic", 50, 7, false, 1.0 / 100, 200, 100},
                                {"hang_200", 200, 1, true, 1.0 / 60, 12, 0}};
  ResultFile file(
      "work and precision: processor time of one step of the world on one thread, and distance to "
      "explicit integration of the same springs (1000 N/m) in small steps, RMS over nodes and "
      "steps",
      {"workload", "solver", "settings", "median_ms", "ratio_to_bullet_10", "rms_error_m",
       "last_error_m", "max_stretch_percent", "mean_stretch_percent"});
  for (const Workload& workload : workloads) {
    measure(workload, file);
    file.write(settings.folder / (sizeof(btScalar) == 4 ? "fast_float32.csv" : "fast_float64.csv"));
  }
}

}  // namespace weft::bench
