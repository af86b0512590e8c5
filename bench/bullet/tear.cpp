#include <algorithm>
#include <functional>
#include <memory>

#include <BulletCollision/CollisionShapes/btSphereShape.h>
#include <tbb/task_arena.h>

#include <weft/bridge/cloth_body.hpp>
#include <weft/bridge/soft_world.hpp>
#include <weft/bridge/tearing.hpp>
#include <weft/mesh/cloth_grid.hpp>

#include "bench/bench.hpp"
#include "bench/result_file.hpp"
#include "bench/stopwatch.hpp"

namespace weft::bench {
namespace {

constexpr double kTimeStep = 1.0 / 60;  // [s]
constexpr int kNodes = 100;             // along an edge
constexpr int kSteps = 90;
constexpr double kClampSpeed = 0.3;  // [m/s]
constexpr int kAfterTear = 15;       // frames
constexpr int kStepsOfGrab = 6;
constexpr int kRuns = 3;

/// A cloth that something tears.
struct Torn {
  bridge::SoftWorld world{{{0, -9.81, 0}, 0.05}};
  ClothMesh mesh;
  bridge::ClothSettings cloth{.collision_margin = 0.01, .time_step = kTimeStep};
  std::vector<forces::LawSpecification> laws = {
      {"gravity", {}, {{"acceleration", {0.0, -9.81, 0.0}}}},
      {"tension", {}, {{"stiffness", {50.0}}}},
      {"velocity_damping", {}, {{"rate", {1.0}}}}};
  TearRule rule{.strain = 0.3};
  btSoftBody* body = nullptr;
  std::function<void(btSoftBody&, int step)> disturb = [](btSoftBody&, int) {};

  void add_body() {
    std::sort(mesh.pinned.begin(), mesh.pinned.end());
    mesh.pinned.erase(std::unique(mesh.pinned.begin(), mesh.pinned.end()), mesh.pinned.end());
    body = &world.add(bridge::make_cloth_body(world.info(), mesh, cloth));
    (void)world.solver().attach_fast(*body, mesh, laws, {.may_sleep = false});
  }
};

ClothGrid sheet() {
  ClothGrid grid;
  grid.nodes = {kNodes, kNodes};
  grid.total_mass = 0.2;
  return grid;
}

/// A sheet held at its rim that a heavy ball tears on its way through.
std::unique_ptr<Torn> torn_by_a_ball() {
  const ClothGrid grid = sheet();
  auto torn = std::make_unique<Torn>();
  torn->mesh = make_cloth_grid(grid);
  for (int i = 0; i < kNodes; ++i) {
    for (const int node : {grid_node(grid, i, 0), grid_node(grid, i, -1), grid_node(grid, 0, i),
                           grid_node(grid, -1, i)}) {
      torn->mesh.pinned.push_back(node);
    }
  }
  torn->add_body();
  auto shape = std::make_shared<btSphereShape>(btScalar(0.16));
  btVector3 inertia;
  shape->calculateLocalInertia(4, inertia);
  btRigidBody::btRigidBodyConstructionInfo info(4, nullptr, shape.get(), inertia);
  info.m_startWorldTransform =
      btTransform(btQuaternion::getIdentity(), btVector3(btScalar(0.03), btScalar(0.3), 0));
  torn->world.add(std::make_unique<btRigidBody>(info), shape)
      .setLinearVelocity(btVector3(0, -4, 0));
  return torn;
}

/// A sheet between two clamps that part, with threads that are not all alike.
std::unique_ptr<Torn> torn_by_clamps(bool bends) {
  const ClothGrid grid = sheet();
  auto torn = std::make_unique<Torn>();
  torn->mesh = make_cloth_grid(grid);
  torn->mesh.pinned_velocities.resize(3, 2 * kNodes);
  for (int i = 0; i < kNodes; ++i) {
    for (const int side : {0, -1}) {
      const auto column = std::ssize(torn->mesh.pinned);
      torn->mesh.pinned_velocities.col(column) << (side == 0 ? -kClampSpeed : kClampSpeed), 0, 0;
      torn->mesh.pinned.push_back(grid_node(grid, side, i));
    }
  }
  if (bends) torn->laws.push_back({"hinge_torsion", {}, {{"rigidity", {1e-5}}}});
  torn->rule.variation = 0.2;
  torn->add_body();
  return torn;
}

/// A sheet that hangs from two corners, and is grabbed and let go somewhere all the time, at a corner too: nothing tears.
std::unique_ptr<Torn> grabbed_here_and_there() {
  const ClothGrid grid = sheet();
  auto torn = std::make_unique<Torn>();
  torn->mesh = make_cloth_grid(grid);
  torn->mesh.pinned = {grid_node(grid, 0, 0), grid_node(grid, -1, 0)};
  torn->rule.strain = 1e3;
  torn->add_body();
  torn->disturb = [grid](btSoftBody& body, int step) {
    if (step % kStepsOfGrab != 0) return;
    const int grab = step / kStepsOfGrab;
    const auto node_of = [&](int number) {
      return number % 3 == 2 ? grid_node(grid, 0, 0)
                             : grid_node(grid, 10 + 23 * number % 80, 20 + 31 * number % 70);
    };
    const auto toggle = [&](int node) {
      const bool is_pinned = body.m_nodes[node].m_im == 0;
      body.setMass(node, is_pinned ? btScalar(grid.total_mass / (kNodes * kNodes)) : btScalar(0));
      body.m_nodes[node].m_v.setZero();
    };
    if (grab > 0) toggle(node_of(grab - 1));
    toggle(node_of(grab));
  };
  return torn;
}

struct Frame {
  double step_ms;
  double tear_ms;
  std::size_t num_split;
};

std::vector<Frame> run(Torn& torn) {
  std::vector<Frame> frames;
  torn.world.step(kTimeStep);  // makes the first factor
  for (int step = 0; step < kSteps; ++step) {
    if (torn.mesh.pinned_velocities.cols() > 0) {
      bridge::set_pinned_velocities(torn.mesh, *torn.body);
    }
    torn.disturb(*torn.body, step);
    const double of_step = processor_time([&] { torn.world.step(kTimeStep); });
    Tear tear;
    const double of_tear = processor_time([&] {
      tear = bridge::tear(torn.world.solver(), *torn.body, torn.mesh, torn.cloth, torn.laws,
                          torn.rule);
    });
    frames.push_back({of_step, of_tear, tear.origins.size()});
  }
  return frames;
}

/// The least time of each frame over several runs, which are alike to the last bit: the machine takes the rest.
std::vector<Frame> run(const std::function<std::unique_ptr<Torn>()>& make) {
  std::vector<Frame> least = run(*make());
  for (int again = 1; again < kRuns; ++again) {
    const std::vector<Frame> frames = run(*make());
    for (std::size_t f = 0; f < frames.size(); ++f) {
      least[f].step_ms = std::min(least[f].step_ms, frames[f].step_ms);
      least[f].tear_ms = std::min(least[f].tear_ms, frames[f].tear_ms);
    }
  }
  return least;
}

struct Times {
  std::vector<double> all;  // [ms] each
  std::vector<double> tearing;
  std::vector<double> others;
  std::vector<double> tears;  // without the step
  std::size_t num_split = 0;
};

Times times_of(const std::vector<Frame>& frames) {
  Times times;
  int since_tear = kAfterTear;
  for (const Frame& frame : frames) {
    const double whole = frame.step_ms + frame.tear_ms;
    ++since_tear;
    if (frame.num_split > 0) since_tear = 0;
    times.all.push_back(whole);
    times.tears.push_back(frame.tear_ms);
    (since_tear < kAfterTear ? times.tearing : times.others).push_back(whole);
    times.num_split += frame.num_split;
  }
  return times;
}

double largest(const std::vector<double>& values) {
  return values.empty() ? 0.0 : *std::max_element(values.begin(), values.end());
}

}  // namespace

void bench_tear(const Settings& settings) {
  ResultFile file(
      "frames of 1/60 s of a cloth of 100 x 100 nodes that is torn, the tear included: processor "
      "time of one thread, of each frame the least of three runs. Tearing frames are those of a "
      "tear and the 14 after; others are the rest. clamps: between clamps that part; ball: held at "
      "its rim, a ball falls through it; grabbed: not torn, but a node is pinned or let go each " +
          std::to_string(kStepsOfGrab) + " frames",
      {"workload", "frames", "tearing_frames", "nodes_split", "median_ms", "median_of_tearing_ms",
       "worst_ms", "worst_over_median", "median_of_others_ms", "worst_of_others_ms",
       "worst_over_median_of_others", "tear_itself_worst_ms"});
  tbb::task_arena arena(1);
  const auto add = [&](const char* name, const std::function<std::unique_ptr<Torn>()>& make) {
    Times frames;
    arena.execute([&] { frames = times_of(run(make)); });
    const double worst = largest(frames.all);
    const double middle = median(frames.all);
    file.add({name, std::to_string(kSteps), std::to_string(frames.tearing.size()),
              std::to_string(frames.num_split), three_digits(middle),
              three_digits(frames.tearing.empty() ? 0.0 : median(frames.tearing)),
              three_digits(worst), three_digits(worst / middle),
              three_digits(median(frames.others)), three_digits(largest(frames.others)),
              three_digits(worst / median(frames.others)), three_digits(largest(frames.tears))});
  };
  add("clamps", [] { return torn_by_clamps(false); });
  add("clamps, bending", [] { return torn_by_clamps(true); });
  add("ball", torn_by_a_ball);
  add("grabbed", grabbed_here_and_there);
  file.write(settings.folder / "tear.csv");
}

}  // namespace weft::bench
