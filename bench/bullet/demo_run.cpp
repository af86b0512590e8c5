// The 32 scenes of Bullet's soft-body demo, from Bullet's own sources with one line changed, each with Bullet's solver and with
// AdoptingSolver:
//
//   weft-demo-scenes 30 bench/results/demo_scenes.csv [scene ...]
//
// A row for each scene: bodies that were adopted, why others were left to Bullet, whether a solver that adopts nothing gives Bullet's
// bits, and for both solvers whether a node exploded (not finite, or 1 km away) or fell through the ground, how far nodes were below
// the ground's top, the largest stretch of links in the last second, and the time that a step takes of all processors.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>
#include <CommonInterfaces/CommonRigidBodyBase.h>
#include <SoftDemo.h>

#include <weft/bridge/adoption/adopting_solver.hpp>

#include "bench/bullet/demo_solver.hpp"

namespace {

constexpr std::array kScenes = {"cloth",
                                "pressure",
                                "volume",
                                "ropes",
                                "rope_attach",
                                "cloth_attach",
                                "sticks",
                                "capsule_collision",
                                "collide",
                                "collide_2",
                                "collide_3",
                                "impact",
                                "aero",
                                "aero_2",
                                "friction",
                                "torus",
                                "torus_match",
                                "bunny",
                                "bunny_match",
                                "cutting",
                                "cluster_deform",
                                "cluster_collide_1",
                                "cluster_collide_2",
                                "cluster_socket",
                                "cluster_hinge",
                                "cluster_combine",
                                "cluster_car",
                                "cluster_robot",
                                "cluster_stack_soft",
                                "cluster_stack_mixed",
                                "tetra_cube",
                                "tetra_bunny"};

constexpr double kStep = 1.0 / 60;  // [s]
// [m] sideways or up; down go bodies that slide off the ground's edge.
constexpr double kFarAway = 1000;
constexpr double kThrough = 2;  // [m] below the top of the ground
/// The ground of the demo: a box in the first scenes, then waves of 5 m on a mesh that has its middle at -12 m.
constexpr std::size_t kFirstOnWaves = 20;
constexpr double kTopOfBox = -10.5;     // [m]
constexpr double kLowestOfWaves = -17;  // [m]
constexpr double kHalfOfGround = 95;    // [m] beside it bodies may fall
constexpr int kMeasuredSteps = 60;

btSoftBodySolver* g_solver = nullptr;

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

struct Outcome {
  int exploded_step = -1;  ///< -1: none
  double depth = 0;        ///< [m] of the lowest node below the top of the ground
  double stretch = 0;      ///< mean over the last second of the largest of all links [-]
  double step_time = 0;    ///< [ms] of processors, all threads together
  int num_solved = 0;      ///< steps of adopted bodies that were awake
  int num_unsolved = 0;    ///< those that ended outside of the tolerance
  std::vector<btVector3> end;
};

class Demo {
 public:
  /// weft: the solver, if it adopts; or none.
  Demo(std::size_t scene, btSoftBodySolver* solver,
       const weft::bridge::SoftBodySolver* weft = nullptr)
      : top_(scene < kFirstOnWaves ? kTopOfBox : kLowestOfWaves), weft_(weft) {
    std::srand(1);
    g_solver = solver;
    CommonExampleOptions options(&helper_, static_cast<int>(scene));
    example_.reset(SoftDemoCreateFunc(options));
    example_->initPhysics();
    world_ = static_cast<btSoftRigidDynamicsWorld*>(
        static_cast<CommonRigidBodyBase*>(example_.get())->m_dynamicsWorld);
  }
  ~Demo() { example_->exitPhysics(); }
  Demo(const Demo&) = delete;
  Demo& operator=(const Demo&) = delete;

  Outcome run(int num_steps) {
    Outcome outcome;
    double seconds = 0;
    for (int step = 0; step < num_steps && outcome.exploded_step < 0; ++step) {
      const std::clock_t start = std::clock();
      world_->stepSimulation(static_cast<btScalar>(kStep), 0);
      seconds += static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
      look_at(step, num_steps, outcome);
      outcome.step_time = 1000 * seconds / (step + 1);
    }
    const btSoftBodyArray& bodies = world_->getSoftBodyArray();
    for (int b = 0; b < bodies.size(); ++b) {
      for (int i = 0; i < bodies[b]->m_nodes.size(); ++i)
        outcome.end.push_back(bodies[b]->m_nodes[i].m_x);
    }
    return outcome;
  }

 private:
  void look_at(int step, int num_steps, Outcome& outcome) const {
    const btSoftBodyArray& bodies = world_->getSoftBodyArray();
    double stretch = 0;
    for (int b = 0; b < bodies.size(); ++b) {
      for (int i = 0; i < bodies[b]->m_nodes.size(); ++i) {
        const btVector3& x = bodies[b]->m_nodes[i].m_x;
        const double far =
            std::max({std::abs(static_cast<double>(x.x())), std::abs(static_cast<double>(x.z())),
                      static_cast<double>(x.y())});
        if (!(far < kFarAway) || !std::isfinite(static_cast<double>(x.length())))
          outcome.exploded_step = step;
        const bool is_over = std::abs(static_cast<double>(x.x())) < kHalfOfGround &&
                             std::abs(static_cast<double>(x.z())) < kHalfOfGround;
        if (is_over) outcome.depth = std::max(outcome.depth, top_ - static_cast<double>(x.y()));
      }
      if (step >= num_steps - kMeasuredSteps)
        stretch = std::max(stretch, largest_stretch(*bodies[b]));
      if (weft_ == nullptr || !weft_->is_fast(*bodies[b])) continue;
      const weft::bridge::StepError error = weft_->step_error(*bodies[b]);
      if (error.newton_iterations == 0) continue;  // asleep
      ++outcome.num_solved;
      if (!error.is_within_tolerance) ++outcome.num_unsolved;
    }
    outcome.stretch += stretch / kMeasuredSteps;
  }

  double top_;
  const weft::bridge::SoftBodySolver* weft_;
  DummyGUIHelper helper_;
  std::unique_ptr<CommonExampleInterface> example_;
  btSoftRigidDynamicsWorld* world_;
};

const char* verdict(const Outcome& outcome) {
  if (outcome.exploded_step >= 0) return "exploded";
  return outcome.depth > kThrough ? "fell through" : "fine";
}

void write_row(std::size_t scene, int num_steps, std::FILE* file) {
  int num_adopted = 0;
  int num_refused = 0;
  int num_blown_up = 0;
  std::string reason;
  weft::bridge::AdoptingSolver adopting;
  adopting.set_on_adoption([&](btSoftBody&, const weft::bridge::AdoptionReport& report) {
    (report.refusal ? num_refused : num_adopted) += 1;
    if (report.refusal) reason = *report.refusal;
  });
  adopting.set_on_blow_up([&](btSoftBody&, const weft::bridge::BodyBlowUp&) { ++num_blown_up; });
  weft::bridge::SoftBodySolver idle;
  const Outcome bullet = Demo(scene, nullptr).run(num_steps);
  const bool is_same = Demo(scene, &idle).run(num_steps).end == bullet.end;
  const Outcome weft = Demo(scene, &adopting, &adopting).run(num_steps);
  std::fprintf(file, "%s,%d,%d,\"%s\",%s,%s,%s,%.3f,%.3f,%.1f,%.1f,%.3f,%.3f,%d,%.1f\n",
               kScenes[scene], num_adopted + num_refused, num_adopted, reason.c_str(),
               is_same ? "equal" : "differ", verdict(bullet), verdict(weft), bullet.depth,
               weft.depth, 100 * bullet.stretch, 100 * weft.stretch, bullet.step_time,
               weft.step_time, num_blown_up,
               100.0 * weft.num_unsolved / std::max(1, weft.num_solved));
  std::fflush(file);
}

}  // namespace

btSoftBodySolver* weft::bench::demo_solver() {
  return g_solver;
}

int main(int argc, char** argv) {
  if (argc < 3) {
    return std::fprintf(stderr, "weft-demo-scenes <seconds> <file.csv> [scene ...]\n"), 2;
  }
  const double seconds = std::atof(argv[1]);
  if (!(seconds >= 1) || !(seconds <= 3600)) {
    std::fprintf(stderr, "seconds = '%s' [s], expected from 1 to 3600\n", argv[1]);
    return 2;
  }
  std::vector<std::size_t> scenes;
  for (int k = 3; k < argc; ++k) {
    const auto* const found = std::find(kScenes.begin(), kScenes.end(), std::string(argv[k]));
    if (found == kScenes.end()) {
      std::fprintf(stderr, "scene = '%s', expected one of Bullet's demo, as cloth\n", argv[k]);
      return 2;
    }
    scenes.push_back(static_cast<std::size_t>(found - kScenes.begin()));
  }
  for (std::size_t s = 0; scenes.size() < kScenes.size() && argc == 3; ++s) scenes.push_back(s);
  std::FILE* const file = std::fopen(argv[2], "w");  // Bullet writes to the standard output
  if (file == nullptr) {
    std::fprintf(stderr, "%s: cannot be written, expected a file in a folder that exists\n",
                 argv[2]);
    return 2;
  }
  std::fprintf(file,
               "scene,bodies,adopted,left to Bullet because,bits with nothing adopted,Bullet,Weft,"
               "Bullet depth [m],Weft depth [m],"
               "Bullet stretch [%%],Weft stretch [%%],Bullet step [ms of processors],Weft step [ms "
               "of processors],blown up,unsolved steps [%%]\n");
  for (const std::size_t scene : scenes) {
    write_row(scene, static_cast<int>(std::lround(seconds / kStep)), file);
  }
  return std::fclose(file) == 0 ? 0 : 2;
}
