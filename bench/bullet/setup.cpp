#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <tbb/task_arena.h>

#include <BulletSoftBody/btSoftBodyHelpers.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>

#include <weft/bridge/adoption/adopting_solver.hpp>
#include <weft/bridge/bullet/bullet_vector.hpp>

#include <btBulletDynamicsCommon.h>

#include "bench/bench.hpp"
#include "bench/result_file.hpp"
#include "bench/stopwatch.hpp"

namespace weft::bench {
namespace {

constexpr double kTimeStep = 1.0 / 60;  // [s]
constexpr int kSteps = 30;

/// A program of Bullet's with the one line changed, in which sheets appear.
struct Program {
  bridge::AdoptingSolver solver;
  btSoftBodyRigidBodyCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher{&configuration};
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver constraints;
  btSoftRigidDynamicsWorld world{&dispatcher, &broadphase, &constraints, &configuration, &solver};
  std::vector<std::unique_ptr<btSoftBody>> bodies;

  Program() {
    world.setGravity(btVector3(0, -10, 0));
    btSoftBodyWorldInfo& info = world.getWorldInfo();
    info.m_gravity = btVector3(0, -10, 0);
    info.m_broadphase = &broadphase;
    info.m_dispatcher = &dispatcher;
    info.m_sparsesdf.Initialize();
  }
  ~Program() {
    for (const auto& body : bodies) world.removeSoftBody(body.get());
  }
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  /// A sheet of n x n nodes and 2 m on two corners, the number-th beside others.
  void make(int n, int number) {
    const auto at = [&](double x, double z) {
      return bridge::to_bullet(Vector3<double>(x + 3 * number, 0, z));
    };
    bodies.emplace_back(btSoftBodyHelpers::CreatePatch(world.getWorldInfo(), at(-1, -1), at(1, -1),
                                                       at(-1, 1), at(1, 1), n, n, 3, true));
    bodies.back()->setTotalMass(1);
  }
  void step() { world.stepSimulation(btScalar(kTimeStep), 0); }
};

void measure(int n, int num_sheets, int num_rounds, ResultFile& file) {
  std::vector<double> make_ms;
  std::vector<double> first_ms;
  std::vector<double> ordinary_ms;
  for (int round = 0; round < num_rounds; ++round) {
    Program program;
    make_ms.push_back(processor_time([&] {
      for (int number = 0; number < num_sheets; ++number) program.make(n, number);
    }));
    first_ms.push_back(processor_time([&] {
      for (const auto& body : program.bodies) program.world.addSoftBody(body.get());
      program.step();
    }));
    std::vector<double> steps;
    for (int step = 0; step < kSteps; ++step) {
      steps.push_back(processor_time([&] { program.step(); }));
    }
    ordinary_ms.push_back(median(steps));
  }
  const double first = median(first_ms);
  const double ordinary = median(ordinary_ms);
  file.add({std::to_string(n * n), std::to_string(num_sheets), three_digits(median(make_ms)),
            three_digits(first), three_digits(ordinary), three_digits(first / ordinary)});
}

}  // namespace

void bench_setup(const Settings& settings) {
  ResultFile file(
      "sheets on two corners that a program of Bullet's makes and AdoptingSolver adopts, steps of "
      "1/60 s, one thread, processor time, medians: making them is Bullet's; the step that adopts "
      "them, and the 30 that follow it",
      {"nodes", "sheets", "make_ms", "adopt_and_first_step_ms", "ordinary_step_ms", "ratio"});
  tbb::task_arena arena(1);
  arena.execute([&] {
    const int num_rounds = std::max(1, settings.num_rounds / 4);
    for (const int n : {20, 50, 100, 200}) measure(n, 1, num_rounds, file);
    measure(20, 100, num_rounds, file);
  });
  file.write(settings.folder / "setup.csv");
}

}  // namespace weft::bench
