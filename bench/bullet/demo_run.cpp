// Scenes of the kinds of Bullet's soft-body demo, with Bullet's solver and with AdoptingSolver, the one line that changes:
//
//   weft-demo-scenes 30 bench/results/demo_scenes.csv
//
// A row for each scene: bodies that were adopted, why others were left to Bullet, and for both solvers whether a node exploded (not
// finite, or 1 km away) or fell through the floor, the largest stretch of links in the last second, and the time of a step.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>

#include <weft/bridge/adoption/adopting_solver.hpp>

#include "bench/bullet/demo_scenes.hpp"

namespace {

using weft::bench::DemoScene;
using weft::bench::DemoWorld;

constexpr double kStep = 1.0 / 60;  // [s]
constexpr double kFarAway = 1000;   // [m]
constexpr double kBelowFloor = 1;   // [m]
constexpr int kMeasuredSteps = 60;

struct Outcome {
  int exploded_step = -1;  ///< -1: none
  double depth = 0;        ///< [m] of the lowest node below the floor
  double stretch = 0;      ///< mean over the last second of the largest of all links [-]
  double step_time = 0;    ///< [ms]
};

/// The largest length of a link over its rest length, minus one.
double largest_stretch(const btSoftBody& body) {
  double most = 0;
  for (int l = 0; l < body.m_links.size(); ++l) {
    const btSoftBody::Link& link = body.m_links[l];
    if (!(link.m_rl > 0) || link.m_bbending) continue;
    const double length = static_cast<double>((link.m_n[0]->m_x - link.m_n[1]->m_x).length());
    most = std::max(most, length / static_cast<double>(link.m_rl) - 1);
  }
  return most;
}

Outcome run(const DemoScene& scene, btSoftBodySolver* solver, int num_steps) {
  std::srand(1);
  DemoWorld world(solver);
  scene.build(world);
  Outcome outcome;
  double seconds = 0;
  for (int step = 0; step < num_steps && outcome.exploded_step < 0; ++step) {
    const auto start = std::chrono::steady_clock::now();
    world.world.stepSimulation(static_cast<btScalar>(kStep), 0);
    seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    double stretch = 0;
    btSoftBodyArray& bodies = world.world.getSoftBodyArray();
    for (int b = 0; b < bodies.size(); ++b) {
      for (int i = 0; i < bodies[b]->m_nodes.size(); ++i) {
        const btVector3& x = bodies[b]->m_nodes[i].m_x;
        if (!(static_cast<double>(x.length()) < kFarAway)) outcome.exploded_step = step;
        outcome.depth = std::max(outcome.depth, DemoWorld::kFloor - static_cast<double>(x.y()));
      }
      if (step >= num_steps - kMeasuredSteps) {
        stretch = std::max(stretch, largest_stretch(*bodies[b]));
      }
    }
    outcome.stretch += stretch / kMeasuredSteps;
    outcome.step_time = 1000 * seconds / (step + 1);
  }
  return outcome;
}

const char* verdict(const DemoScene& scene, const Outcome& outcome) {
  if (outcome.exploded_step >= 0) return "exploded";
  if (scene.stays_above_floor && outcome.depth > kBelowFloor) return "fell through";
  return "fine";
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return std::fprintf(stderr, "weft-demo-scenes <seconds> <file.csv>\n"), 2;
  const double seconds = std::atof(argv[1]);
  if (!(seconds >= 1) || !(seconds <= 3600)) {
    std::fprintf(stderr, "seconds = '%s' [s], expected from 1 to 3600\n", argv[1]);
    return 2;
  }
  std::FILE* const file = std::fopen(argv[2], "w");  // Bullet writes to the standard output
  if (file == nullptr) {
    std::fprintf(stderr, "%s: cannot be written, expected a file in a folder that exists\n",
                 argv[2]);
    return 2;
  }
  const auto num_steps = static_cast<int>(std::lround(seconds / kStep));
  std::fprintf(
      file,
      "scene,bodies,adopted,left to Bullet because,Bullet,Weft,Bullet depth [m],Weft depth [m],"
      "Bullet stretch [%%],Weft stretch [%%],Bullet step [ms],Weft step [ms],blown up\n");
  for (const DemoScene& scene : weft::bench::demo_scenes()) {
    int num_adopted = 0;
    int num_refused = 0;
    int num_blown_up = 0;
    std::string reason;
    weft::bridge::AdoptingSolver solver;
    solver.set_on_adoption([&](btSoftBody&, const weft::bridge::AdoptionReport& report) {
      (report.refusal ? num_refused : num_adopted) += 1;
      if (report.refusal) reason = *report.refusal;
    });
    solver.set_on_blow_up([&](btSoftBody&, const weft::bridge::BodyBlowUp&) { ++num_blown_up; });
    const Outcome bullet = run(scene, nullptr, num_steps);
    const Outcome weft = run(scene, &solver, num_steps);
    std::fprintf(file, "%s,%d,%d,\"%s\",%s,%s,%.3f,%.3f,%.1f,%.1f,%.3f,%.3f,%d\n",
                 scene.name.c_str(), num_adopted + num_refused, num_adopted, reason.c_str(),
                 verdict(scene, bullet), verdict(scene, weft), bullet.depth, weft.depth,
                 100 * bullet.stretch, 100 * weft.stretch, bullet.step_time, weft.step_time,
                 num_blown_up);
    std::fflush(file);
  }
  return std::fclose(file) == 0 ? 0 : 2;
}
