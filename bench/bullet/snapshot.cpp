#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
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
const btVector3 kAcross(0, 0, -1);      // the axis of the shoulders
constexpr int kRollback = 8;            // steps that a networked game simulates again

double milliseconds(const std::function<void()>& call) {
  const auto start = std::chrono::steady_clock::now();
  call();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
      .count();
}

/// A cape of n x n nodes.
struct Cape {
  std::string name;
  int n;
  double tolerance;
  int num_led_rows;  ///< that follow a walking body's back; 0: two shoulders hold it, and it swings against a ball
};

constexpr double kGames = 0.03;  // docs/implicit_step.md: what games take
const std::vector<Cape> kCapes = {{"on two shoulders, against a ball", 24, 0.001, 0},
                                  {"on two shoulders, against a ball", 50, 0.001, 0},
                                  {"on two shoulders, against a ball", 50, kGames, 0},
                                  {"of which 800 nodes are led", 50, 0.001, 16},
                                  {"of which 800 nodes are led", 50, kGames, 16}};

class CapeRun {
 public:
  explicit CapeRun(const Cape& cape) {
    ClothGrid grid;
    grid.nodes = {cape.n, cape.n};
    grid.size = {1.2, 1.2};
    grid.total_mass = 0.4;
    ClothMesh mesh = make_cloth_grid(grid);
    mesh.pinned = {grid_node(grid, 0, 0), grid_node(grid, 0, cape.n - 1)};
    for (int row = 0; row < cape.num_led_rows; ++row) {
      for (int column = 0; column < cape.n; ++column) {
        led_.push_back(grid_node(grid, row, column));
      }
    }
    if (!led_.empty()) mesh.pinned = led_;
    body_ = &world_.add(bridge::make_cloth_body(
        world_.info(), mesh, {.collision_margin = 0.01, .friction = 0.5, .time_step = kTimeStep}));
    for (const int node : led_) starts_.push_back(body_->m_nodes[node].m_x);
    const auto refusal =
        world_.solver().attach_fast(*body_, mesh,
                                    {{"gravity", {}, {{"acceleration", {0.0, -9.81, 0.0}}}},
                                     {"tension", {}, {{"stiffness", {1000.0}}}},
                                     {"velocity_damping", {}, {{"rate", {0.5}}}}},
                                    {.solver = {.tolerance = cape.tolerance}, .may_sleep = false});
    if (refusal) throw Error("bench snapshot: " + *refusal);
    if (!led_.empty()) return;
    const auto ball = std::make_shared<btSphereShape>(btScalar(0.25));
    btTransform place = btTransform::getIdentity();
    place.setOrigin(btVector3(btScalar(-0.4), btScalar(-0.5), 0));
    auto back = std::make_unique<btRigidBody>(btScalar(0), nullptr, ball.get());
    back->setWorldTransform(place);
    (void)world_.add(std::move(back), ball);
  }

  /// The back sways by 10 cm, once a second, and hangs down by a quarter of a turn in the first half second.
  void step(int number) {
    const double time = (number + 1) * kTimeStep;
    const btScalar turned = btScalar(std::min(time, 0.5) * std::numbers::pi);
    const btScalar sway = btScalar(0.1 * std::sin(2 * std::numbers::pi * time));
    for (std::size_t k = 0; k < led_.size(); ++k) {
      btVector3 place = starts_[k];
      place = (place - starts_.front()).rotate(kAcross, turned) + starts_.front();
      body_->m_nodes[led_[k]].m_x = place + btVector3(sway, 0, sway);
    }
    world_.step(kTimeStep);
    ++num_steps_;
    if (!world_.solver().step_error(*body_).is_within_tolerance) ++num_unsolved_;
  }
  /// Share of the steps that the solver's budget ended [%].
  [[nodiscard]] double unsolved_percent() const { return 100.0 * num_unsolved_ / num_steps_; }
  void save(bridge::Snapshot& snapshot) { snapshot.save(world_.world(), world_.solver()); }
  void restore(const bridge::Snapshot& snapshot) {
    snapshot.restore(world_.world(), world_.solver());
  }

 private:
  bridge::SoftWorld world_{{{0, -9.81, 0}, 0.05}};
  btSoftBody* body_ = nullptr;
  std::vector<int> led_;
  std::vector<btVector3> starts_;
  int num_steps_ = 0;
  int num_unsolved_ = 0;
};

void measure(const Cape& cape, int threads, int num_rounds, ResultFile& file) {
  CapeRun run(cape);
  int number = 0;
  while (number < 60) run.step(number++);
  bridge::Snapshot snapshot;
  bridge::Snapshot other;
  std::vector<double> save_ms;
  std::vector<double> restore_ms;
  std::vector<double> rollback_ms;
  std::vector<double> step_ms;
  for (int round = 0; round < num_rounds; ++round) {
    save_ms.push_back(milliseconds([&] { run.save(snapshot); }));
    for (int step = 0; step < kRollback; ++step) {
      step_ms.push_back(milliseconds([&] { run.step(number + step); }));
    }
    restore_ms.push_back(milliseconds([&] { run.restore(snapshot); }));
    rollback_ms.push_back(milliseconds([&] {
      run.restore(snapshot);
      for (int step = 0; step < kRollback; ++step) {
        run.step(number + step);
        run.save(other);
      }
    }));
    number += kRollback;
  }
  const int num_nodes = cape.n * cape.n;
  const double bytes = static_cast<double>(snapshot.size()) / num_nodes;
  file.add({cape.name, three_digits(cape.tolerance), std::to_string(num_nodes),
            std::to_string(threads), three_digits(median(save_ms)),
            three_digits(median(restore_ms)), three_digits(bytes),
            three_digits(bytes - 6 * sizeof(btScalar)), three_digits(median(step_ms)),
            three_digits(median(rollback_ms)), three_digits(run.unsolved_percent())});
}

}  // namespace

void bench_snapshot(const Settings& settings) {
  ResultFile file(
      "capes of 1.2 m, steps of 1/60 s, medians: a snapshot of "
      "the world, and a rollback, which is a restore and eight steps with a snapshot after each",
      {"cape", "tolerance", "nodes", "threads", "save_ms", "restore_ms", "bytes_per_node",
       "beside_positions_and_velocities_bytes", "step_ms", "rollback_of_8_ms", "unsolved_percent"});
  for (const int threads : {1, 2}) {
    tbb::task_arena arena(threads);
    arena.execute([&] {
      for (const Cape& cape : kCapes) measure(cape, threads, 2 * settings.num_rounds, file);
    });
  }
  file.write(settings.folder / "snapshot.csv");
}

}  // namespace weft::bench
