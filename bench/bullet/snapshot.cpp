#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <tbb/task_arena.h>

#include <weft/bridge/cloth_body.hpp>
#include <weft/bridge/snapshot.hpp>
#include <weft/bridge/soft_world.hpp>
#include <weft/core/error.hpp>
#include <weft/mesh/cloth_grid.hpp>

#include <btBulletDynamicsCommon.h>

#include "bench/bench.hpp"
#include "bench/result_file.hpp"
#include "bench/stopwatch.hpp"

namespace weft::bench {
namespace {

constexpr double kTimeStep = 1.0 / 60;  // [s]
constexpr int kRollback = 8;            // steps that a networked game simulates again

double milliseconds(const std::function<void()>& call) {
  const auto start = std::chrono::steady_clock::now();
  call();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
      .count();
}

/// A cape of n x n nodes on two shoulders that swings against a ball, a body's back.
void measure(int n, int threads, int num_rounds, ResultFile& file) {
  ClothGrid grid;
  grid.nodes = {n, n};
  grid.size = {1.2, 1.2};
  grid.total_mass = 0.4;
  ClothMesh mesh = make_cloth_grid(grid);
  mesh.pinned = {grid_node(grid, 0, 0), grid_node(grid, 0, n - 1)};
  bridge::SoftWorld world({{0, -9.81, 0}, 0.05});
  btSoftBody& body = world.add(bridge::make_cloth_body(
      world.info(), mesh, {.collision_margin = 0.01, .friction = 0.5, .time_step = kTimeStep}));
  const auto refusal =
      world.solver().attach_fast(body, mesh,
                                 {{"gravity", {}, {{"acceleration", {0.0, -9.81, 0.0}}}},
                                  {"tension", {}, {{"stiffness", {1000.0}}}},
                                  {"velocity_damping", {}, {{"rate", {0.5}}}}},
                                 {.may_sleep = false});
  if (refusal) throw Error("bench snapshot: " + *refusal);
  const auto ball = std::make_shared<btSphereShape>(btScalar(0.25));
  btTransform place = btTransform::getIdentity();
  place.setOrigin(btVector3(btScalar(-0.4), btScalar(-0.5), 0));
  auto back = std::make_unique<btRigidBody>(btScalar(0), nullptr, ball.get());
  back->setWorldTransform(place);
  (void)world.add(std::move(back), ball);
  for (int step = 0; step < 60; ++step) world.step(kTimeStep);
  bridge::Snapshot snapshot;
  bridge::Snapshot other;
  std::vector<double> save_ms;
  std::vector<double> restore_ms;
  std::vector<double> rollback_ms;
  std::vector<double> step_ms;
  for (int round = 0; round < num_rounds; ++round) {
    save_ms.push_back(milliseconds([&] { snapshot.save(world.world(), world.solver()); }));
    for (int step = 0; step < kRollback; ++step) {
      step_ms.push_back(milliseconds([&] { world.step(kTimeStep); }));
    }
    restore_ms.push_back(milliseconds([&] { snapshot.restore(world.world(), world.solver()); }));
    rollback_ms.push_back(milliseconds([&] {
      snapshot.restore(world.world(), world.solver());
      for (int step = 0; step < kRollback; ++step) {
        world.step(kTimeStep);
        other.save(world.world(), world.solver());
      }
    }));
  }
  const double bytes = static_cast<double>(snapshot.size()) / (n * n);
  file.add({std::to_string(n * n), std::to_string(threads), three_digits(median(save_ms)),
            three_digits(median(restore_ms)), three_digits(bytes),
            three_digits(bytes - 6 * sizeof(btScalar)), three_digits(median(step_ms)),
            three_digits(median(rollback_ms))});
}

}  // namespace

void bench_snapshot(const Settings& settings) {
  ResultFile file(
      "a cape on two shoulders beside a ball, steps of 1/60 s, medians: a snapshot of "
      "its world, and a rollback, which is a restore and eight steps with a snapshot after each",
      {"nodes", "threads", "save_ms", "restore_ms", "bytes_per_node",
       "beside_positions_and_velocities_bytes", "step_ms", "rollback_of_8_ms"});
  for (const int threads : {1, 2}) {
    tbb::task_arena arena(threads);
    arena.execute([&] {
      for (const int n : {24, 50}) measure(n, threads, 2 * settings.num_rounds, file);
    });
  }
  file.write(settings.folder / "snapshot.csv");
}

}  // namespace weft::bench
