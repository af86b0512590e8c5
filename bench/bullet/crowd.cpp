#include <algorithm>
#include <array>
#include <chrono>
#include <memory>
#include <numeric>
#include <thread>

#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>
#include <tbb/task_arena.h>

#include <weft/bridge/classic/nodes/node_state.hpp>
#include <weft/bridge/cloth_body.hpp>
#include <weft/bridge/soft_world.hpp>
#include <weft/core/trace.hpp>
#include <weft/mesh/cloth_grid.hpp>
#include <weft/mesh/icosphere.hpp>

#include "bench/bench.hpp"
#include "bench/line_transfer.hpp"
#include "bench/result_file.hpp"
#include "bench/stopwatch.hpp"

namespace weft::bench {
namespace {

constexpr double kTimeStep = 1.0 / 60;  // [s]
constexpr int kWarmUp = 20;             // steps: memory is there, cloth has begun to move
constexpr int kTogether = 12;           // steps that are timed together
/// Medians of 15 rounds of a small world differ by a tenth from run to run, of 60 by a few hundredths; a large one takes
/// seconds for a round.
constexpr int kRounds = 60;
constexpr int kRoundsOfCrowd = 10;
constexpr int kRoundsOfTimes = 10;  // Bullet is slow
/// In place of so many that the machine had two processors for: times as many rounds at most.
constexpr int kMostTries = 3;
/// What two worlds get done at the same time, over one: from which on the machine has two processors for them.
constexpr double kTwoProcessors = 1.8;
/// [us] for a line of the cache from one to the other, up to which they share a cache.
constexpr double kNear = 0.12;

enum class Workload { kCrowd, kSmallBall, kBall, kClassic, kSmallHang, kHang };

struct Name {
  Workload workload;
  const char* text;
};
constexpr Name kNames[] = {{Workload::kCrowd, "crowd"},       {Workload::kSmallBall, "ball_642"},
                           {Workload::kBall, "ball_2562"},    {Workload::kClassic, "classic"},
                           {Workload::kSmallHang, "hang_50"}, {Workload::kHang, "hang_100"}};

struct Solver {
  int num_threads = 1;
  int bullet_iterations = 0;  ///< 0: the fast solver
};

ClothMesh sheet(int nodes, double size, const Vector3<double>& center, double mass) {
  ClothGrid grid;
  grid.nodes = {nodes, nodes};
  grid.size = {size, size};
  grid.center = center;
  grid.total_mass = mass;
  grid.lumping = MassLumping::kUniform;
  return make_cloth_grid(grid);
}

std::vector<ClothMesh> meshes_of(Workload workload) {
  std::vector<ClothMesh> meshes;
  switch (workload) {
    case Workload::kCrowd:
      for (int i = 0; i < 100; ++i) {
        const Vector3<double> center(1.5 * (i % 10), 0.05 + 0.002 * i, 1.5 * (i / 10));
        meshes.push_back(sheet(20, 1, center, 0.25));
      }
      break;
    case Workload::kSmallBall:
    case Workload::kBall: {
      Icosphere sphere;
      sphere.radius = 0.5;
      sphere.frequency = workload == Workload::kBall ? 16 : 8;
      sphere.center = {0, 0.6, 0};
      meshes.push_back(make_icosphere(sphere));
      break;
    }
    case Workload::kClassic:
      meshes.push_back(sheet(50, 7, {0, 2.2, 0}, 1));
      break;
    case Workload::kSmallHang:
    case Workload::kHang: {
      const int nodes = workload == Workload::kHang ? 100 : 50;
      meshes.push_back(sheet(nodes, 1, {0, 0, 0}, 1));
      meshes[0].pinned = {0, nodes - 1};
      break;
    }
  }
  return meshes;
}

class World {
 public:
  World(Workload workload, const Solver& solver)
      : arena_(solver.num_threads), world_({{0, -9.81, 0}, 0.1}) {
    arena_.execute([&] {
      for (const ClothMesh& mesh : meshes_of(workload)) add(workload, mesh, solver);
    });
    if (workload == Workload::kHang || workload == Workload::kSmallHang) return;
    std::shared_ptr<btCollisionShape> shape = std::make_shared<btSphereShape>(btScalar(2));
    if (workload != Workload::kClassic) {
      shape = std::make_shared<btBoxShape>(btVector3(40, 1, 40));
    }
    btRigidBody::btRigidBodyConstructionInfo info(0, nullptr, shape.get());
    const btScalar height = workload == Workload::kClassic ? 0 : -1;
    info.m_startWorldTransform = btTransform(btQuaternion::getIdentity(), btVector3(0, height, 0));
    world_.add(std::make_unique<btRigidBody>(info), std::move(shape));
  }

  /// Time by the clock [ms].
  double step() {
    const auto start = std::chrono::steady_clock::now();
    arena_.execute([&] { world_.step(kTimeStep); });
    return 1e3 * std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }
  [[nodiscard]] bool is_same(const World& other) const {
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
      Matrix3X<btScalar> x[2];
      Matrix3X<btScalar> v;
      bridge::read_nodes(*bodies_[b], x[0], v);
      bridge::read_nodes(*other.bodies_[b], x[1], v);
      if (x[0] != x[1]) return false;
    }
    return true;
  }
  [[nodiscard]] int num_nodes() const {
    return std::accumulate(bodies_.begin(), bodies_.end(), 0, [](int sum, const btSoftBody* body) {
      return sum + body->m_nodes.size();
    });
  }

 private:
  void add(Workload workload, const ClothMesh& mesh, const Solver& solver) {
    const double stiffness = workload == Workload::kCrowd ? 100.0 : 1000.0;  // [N/m]
    bridge::ClothSettings settings{.collision_margin = 0.01, .time_step = kTimeStep};
    if (solver.bullet_iterations > 0) {
      settings.position_iterations = solver.bullet_iterations;
      settings.links.push_back({{}, stiffness});
    }
    btSoftBody& body = world_.add(bridge::make_cloth_body(world_.info(), mesh, settings));
    std::vector<forces::LawSpecification> laws = {
        {"gravity", {}, {{"acceleration", {0.0, -9.81, 0.0}}}}};
    if (workload == Workload::kBall || workload == Workload::kSmallBall) {
      laws.push_back({"pressure", {}, {{"pressure", {100.0}}}});
    }
    if (solver.bullet_iterations > 0) {
      world_.solver().attach(body, mesh, laws);
    } else {
      laws.push_back({"tension", {}, {{"stiffness", {stiffness}}}});
      (void)world_.solver().attach_fast(body, mesh, laws, {.may_sleep = false});
    }
    bodies_.push_back(&body);
  }

  tbb::task_arena arena_;
  bridge::SoftWorld world_;
  std::vector<btSoftBody*> bodies_;
};

/// Sums over a trace of one thread [ms], by name.
double sum_of(const std::vector<TraceThread>& threads, std::string_view name) {
  double sum = 0;
  for (const TraceThread& thread : threads) {
    for (const TraceEvent& event : thread.events) {
      if (event.name == name) sum += 1e-6 * static_cast<double>(event.end - event.begin);
    }
  }
  return sum;
}

void add_phases(const Name& name, World& world, ResultFile& file) {
  constexpr int kTraced = 20;
  double total = 0;
  start_trace();
  for (int step = 0; step < kTraced; ++step) total += world.step();
  const std::vector<TraceThread> trace = stop_trace();
  const double laws = sum_of(trace, "forces");
  const double predict = sum_of(trace, "predict motion");
  const double solution = sum_of(trace, "implicit solve");
  const double constraints = sum_of(trace, "solve constraints");
  const double update = sum_of(trace, "update soft bodies");
  const auto per_step = [&](double ms) { return three_digits(ms / kTraced); };
  file.add({name.text, std::to_string(world.num_nodes()), per_step(total), per_step(laws),
            per_step(predict - laws), per_step(total - predict - constraints - update),
            per_step(solution), per_step(constraints - solution), per_step(update),
            three_digits(100 * (1 - (laws + solution) / total))});
}

/// Time by the clock of some steps [ms].
double time_of(World& world) {
  double sum = 0;
  for (int step = 0; step < kTogether; ++step) sum += world.step();
  return sum;
}

/// The same of two worlds at the same time.
double time_of(World& world, World& other) {
  const auto start = std::chrono::steady_clock::now();
  std::thread helper([&] { time_of(other); });
  time_of(world);
  helper.join();
  return 1e3 * std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void add_threads(const Name& name, ResultFile& times, ResultFile& phases) {
  World one(name.workload, {});
  World other(name.workload, {});
  World two(name.workload, {.num_threads = 2});
  World bullet(name.workload, {.bullet_iterations = 10});
  for (World* world : {&one, &other, &two, &bullet}) {
    for (int step = 0; step < kWarmUp; ++step) world->step();
  }
  std::vector<double> ms[3];
  // The first: rounds with two processors that share a cache; the second: the other rounds.
  std::array<std::vector<double>, 2> speed_ups;
  std::array<std::vector<double>, 2> limits;
  std::array<std::vector<double>, 2> transfers;
  // The processors of a virtual machine may be one for a while: before and after, for of the rounds themselves chance
  // would pass those that it makes look well.
  const auto limit = [&] { return 2 * time_of(one) / time_of(one, other); };
  int num_done = 0;
  const int num_rounds = name.workload == Workload::kCrowd ? kRoundsOfCrowd : kRounds;
  while (std::ssize(limits[0]) < num_rounds && num_done < kMostTries * num_rounds) {
    const double transfer_before = line_transfer_time();
    const double before = limit();
    const double alone = time_of(one);
    const double by_two = time_of(two);
    const double after = limit();
    const double transfer_after = line_transfer_time();
    for (int step = 0; step < 4 * kTogether; ++step) two.step();  // as often as the first
    for (int step = 0; step < 3 * kTogether; ++step) other.step();
    ++num_done;
    if (num_done <= kRoundsOfTimes) {  // of the same steps
      for (int step = 0; step < 4 * kTogether; ++step) bullet.step();
      ms[0].push_back(alone / kTogether);
      ms[1].push_back(by_two / kTogether);
      ms[2].push_back(time_of(bullet) / kTogether);
    }
    const bool is_far = transfer_before > kNear;
    if (std::min(before, after) < kTwoProcessors || (transfer_after > kNear) != is_far) continue;
    speed_ups[is_far ? 1 : 0].push_back(alone / by_two);
    limits[is_far ? 1 : 0].push_back(std::min(before, after));
    transfers[is_far ? 1 : 0].push_back(transfer_after);
  }
  const bool is_same = one.is_same(two);
  const auto text = [](std::vector<double> values) {
    return values.empty() ? std::string("-") : three_digits(median(values));
  };
  times.add({name.text, std::to_string(one.num_nodes()), text(ms[0]), text(ms[1]), text(ms[2]),
             text(speed_ups[0]), text(limits[0]), text(transfers[0]),
             std::to_string(limits[0].size()), text(speed_ups[1]), text(limits[1]),
             text(transfers[1]), std::to_string(limits[1].size()), std::to_string(num_done),
             is_same ? "yes" : "no"});
  add_phases(name, one, phases);
}

}  // namespace

void bench_threads(const Settings& settings) {
  ResultFile times(
      "a step of 1/60 s of whole worlds by the clock, medians over ten rounds of steps in turn: "
      "the fast "
      "solver (2 x 4) on one and two threads, Bullet with 10 iterations on one; crowd: 100 cloths "
      "of "
      "20 x 20 on a plane; speed_up: in more such rounds, those with two processors, before and "
      "after "
      "which two such worlds at the same time, on a thread each, get at least 1.8 times as much "
      "done as "
      "one (two_worlds: that, the lower), and which share a cache: a line takes at most .12 us "
      "from one "
      "to the other (line_us); far: the same where it takes longer",
      {"workload", "nodes", "one_thread_ms", "two_threads_ms", "bullet_10_ms", "speed_up",
       "two_worlds", "line_us", "rounds_with_two_processors", "speed_up_far", "two_worlds_far",
       "line_us_far", "rounds_far", "rounds", "equal_bits"});
  ResultFile phases(
      "what a step of the fast solver on one thread is made of; collide: Bullet's search for pairs "
      "and contacts, and "
      "rigid bodies; contacts: what else stands between predicted and final places; rest_percent: "
      "all but laws and solution",
      {"workload", "nodes", "step_ms", "laws_ms", "predict_ms", "collide_ms", "solve_ms",
       "contacts_ms", "update_ms", "rest_percent"});
  for (const Name& name : kNames) add_threads(name, times, phases);
  times.write(settings.folder / "threads.csv");
  phases.write(settings.folder / "phases.csv");
}

}  // namespace weft::bench
