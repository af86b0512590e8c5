#include <chrono>
#include <memory>

#include <BulletSoftBody/btSoftBody.h>
#include <tbb/task_arena.h>

#include <weft/bridge/cloth_body.hpp>
#include <weft/bridge/soft_world.hpp>
#include <weft/custom_forces/registry.hpp>
#include <weft/engines/bullet/bullet_shapes.hpp>
#include <weft/scenes/catalog.hpp>

#include "bench/bench.hpp"
#include "bench/laws/law_cases.hpp"
#include "bench/result_file.hpp"
#include "bench/stopwatch.hpp"

namespace weft::bench {
namespace {

using forces::LawSpecification;

/// The laws that have been asked for on top of Bullet.
enum class Laws { kNone, kOfTheScene, kAllOfTheRegistry };

const LawSpecification& tension_of(const scenes::Cloth& cloth) {
  for (const LawSpecification& law : cloth.laws) {
    if (law.law == "tension") return law;
  }
  return cloth.laws.front();
}

/// drape_sphere in a world of its own.
class Drape {
 public:
  Drape(const scenes::Scene& scene, bool has_links, Laws laws)
      : world_({scene.world.gravity, scenes::distance_field_voxel(scene)}) {
    for (const scenes::Collider& collider : scene.colliders) {
      scenes::BulletCollider made = scenes::make_bullet_collider(collider);
      world_.add(std::move(made.body), std::move(made.shape));
    }
    const scenes::Cloth& cloth = scene.cloths.front();
    ClothMesh mesh = scenes::make_mesh(cloth);
    connect(mesh, "corners", 1225, {0, 49, 2450, 2499});
    bridge::ClothSettings settings{.collision_margin = cloth.collision_margin,
                                   .friction = cloth.friction,
                                   .position_iterations = scene.bullet.position_iterations,
                                   .time_step = scene.world.time_step};
    if (has_links) {
      const LawSpecification tension = forces::checked(tension_of(cloth));
      settings.links.push_back({tension.sets, tension.parameters.at("stiffness").at(0)});
    }
    btSoftBody& body = world_.add(bridge::make_cloth_body(world_.info(), mesh, settings));
    if (laws == Laws::kNone) {
      // Bullet's own gravity: without laws the solver is Bullet's default one, bit for bit.
      world_.info().m_gravity.setValue(0, btScalar(scene.world.gravity[1]), 0);
      return;
    }
    std::vector<LawSpecification> attached;
    for (const LawSpecification& law : cloth.laws) {
      if (!has_links || law.law != "tension") attached.push_back(law);
    }
    if (laws == Laws::kAllOfTheRegistry) {
      // So weak that they change nothing to be seen; they cost what they cost.
      constexpr double kSize = 1e-9;
      for (const LawCase& c : law_cases(mesh, kSize)) {
        const bool is_there = c.id == "tension" || c.id == "gravity" || c.id == "velocity_damping";
        const forces::LawTraits& traits = forces::find_law(c.id)->traits;
        if (!is_there && !traits.needs_closed_surface) attached.push_back(c.specification);
      }
    }
    world_.solver().attach(body, mesh, attached);
  }

  void step(double time_step) { world_.step(time_step); }

 private:
  bridge::SoftWorld world_;
};

struct Case {
  std::string name;
  int num_threads;
  std::unique_ptr<Drape> drape;
  std::vector<double> times = {};  ///< [ms]
};

}  // namespace

void bench_bullet(const Settings& settings) {
  const scenes::Scene scene = scenes::load_scene("drape_sphere");
  std::vector<Case> cases;
  const auto add = [&](const std::string& name, int threads, bool has_links, Laws laws) {
    cases.push_back({name, threads, std::make_unique<Drape>(scene, has_links, laws)});
  };
  add("bullet_default", 1, true, Laws::kNone);
  for (const int threads : {1, 2}) add("links_and_scene_laws", threads, true, Laws::kOfTheScene);
  for (const int threads : {1, 2}) add("all_scene_laws", threads, false, Laws::kOfTheScene);
  for (const int threads : {1, 2}) {
    add("links_and_every_law", threads, true, Laws::kAllOfTheRegistry);
    add("every_law", threads, false, Laws::kAllOfTheRegistry);
  }
  // From the fall through the impact into the drape: 3 s.
  constexpr int kNumSteps = 300;
  for (int step = 0; step < kNumSteps; ++step) {
    for (Case& c : cases) {
      tbb::task_arena arena(c.num_threads);
      arena.execute([&] {
        const auto start = std::chrono::steady_clock::now();
        c.drape->step(scene.world.time_step);
        c.times.push_back(
            std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
                .count());
      });
    }
  }
  ResultFile file(
      "one step of drape_sphere (2500 nodes, 28518 springs, 20 position iterations), median over " +
          std::to_string(kNumSteps) +
          " steps taken in turn; links: Bullet carries the tension, else a law does",
      {"case", "scalar", "threads", "median_ms", "ratio_to_bullet_default"});
  const double bullet = median(cases.front().times);
  for (Case& c : cases) {
    const double time = median(c.times);
    file.add({c.name, sizeof(btScalar) == 4 ? "float" : "double", std::to_string(c.num_threads),
              three_digits(time), three_digits(time / bullet)});
  }
  file.write(settings.folder /
             (sizeof(btScalar) == 4 ? "bullet_float32.csv" : "bullet_float64.csv"));
}

}  // namespace weft::bench
