#include <chrono>
#include <memory>

#include <BulletCollision/CollisionShapes/btSphereShape.h>
#include <tbb/task_arena.h>

#include <weft/bridge/cloth_body.hpp>
#include <weft/bridge/soft_world.hpp>
#include <weft/bridge/tearing.hpp>
#include <weft/custom_forces/core/cloth_grid.hpp>

#include "bench/bench.hpp"
#include "bench/result_file.hpp"
#include "bench/stopwatch.hpp"

namespace weft::bench {
namespace {

constexpr double kTimeStep = 1.0 / 60;  // [s]
constexpr int kNodes = 100;             // along an edge
constexpr int kSteps = 90;

double milliseconds(const std::function<void()>& call) {
  const auto start = std::chrono::steady_clock::now();
  call();
  return 1e3 * std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

// A sheet held at its rim that a heavy ball tears on its way through.
void bench_tear(const Settings& settings) {
  ResultFile file(
      "frames of 1/60 s of a cloth of 100 x 100 nodes that a ball tears, the tear included, on one "
      "thread; a tear "
      "makes the factor anew",
      {"frames", "frames_with_tears", "nodes_split", "median_ms", "median_of_tearing_ms",
       "worst_ms", "worst_over_median", "tear_itself_worst_ms"});
  ClothGrid grid;
  grid.nodes = {kNodes, kNodes};
  grid.total_mass = 0.2;
  ClothMesh mesh = make_cloth_grid(grid);
  for (int i = 0; i < kNodes; ++i) {
    for (const int node : {grid_node(grid, i, 0), grid_node(grid, i, -1), grid_node(grid, 0, i),
                           grid_node(grid, -1, i)}) {
      mesh.pinned.push_back(node);
    }
  }
  std::sort(mesh.pinned.begin(), mesh.pinned.end());
  mesh.pinned.erase(std::unique(mesh.pinned.begin(), mesh.pinned.end()), mesh.pinned.end());
  const std::vector<forces::LawSpecification> laws = {
      {"gravity", {}, {{"acceleration", {0.0, -9.81, 0.0}}}},
      {"tension", {}, {{"stiffness", {50.0}}}},
      {"velocity_damping", {}, {{"rate", {1.0}}}}};
  bridge::SoftWorld world({{0, -9.81, 0}, 0.05});
  const bridge::ClothSettings cloth{.collision_margin = 0.01, .time_step = kTimeStep};
  btSoftBody& body = world.add(bridge::make_cloth_body(world.info(), mesh, cloth));
  (void)world.solver().attach_fast(body, mesh, laws, {.may_sleep = false});
  auto shape = std::make_shared<btSphereShape>(btScalar(0.16));
  btVector3 inertia;
  shape->calculateLocalInertia(4, inertia);
  btRigidBody::btRigidBodyConstructionInfo info(4, nullptr, shape.get(), inertia);
  info.m_startWorldTransform =
      btTransform(btQuaternion::getIdentity(), btVector3(btScalar(0.03), btScalar(0.3), 0));
  world.add(std::make_unique<btRigidBody>(info), shape).setLinearVelocity(btVector3(0, -4, 0));
  TearRule rule;
  rule.strain = 0.3;
  tbb::task_arena arena(1);
  std::vector<double> all;
  std::vector<double> tearing;
  std::vector<double> tears;
  std::size_t num_split = 0;
  arena.execute([&] {
    world.step(kTimeStep);  // makes the first factor
    bool has_torn = false;
    for (int step = 0; step < kSteps; ++step) {
      const double of_step = milliseconds([&] { world.step(kTimeStep); });
      Tear tear;
      const double of_tear =
          milliseconds([&] { tear = bridge::tear(world.solver(), body, mesh, cloth, laws, rule); });
      all.push_back(of_step + of_tear);
      tears.push_back(of_tear);
      if (has_torn || tear.any()) tearing.push_back(of_step + of_tear);
      has_torn = tear.any();
      num_split += tear.origins.size();
    }
  });
  const double worst = *std::max_element(all.begin(), all.end());
  const double middle = median(all);
  file.add({std::to_string(kSteps), std::to_string(tearing.size()), std::to_string(num_split),
            three_digits(middle), three_digits(tearing.empty() ? 0.0 : median(tearing)),
            three_digits(worst), three_digits(worst / middle),
            three_digits(*std::max_element(tears.begin(), tears.end()))});
  file.write(settings.folder / "tear.csv");
}

}  // namespace weft::bench
