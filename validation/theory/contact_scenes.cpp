// Flat cloths on a plane with Coulomb friction: one slides down a slope, one is thrown along the ground and stops.
// Tested by tests/validation/theory_test.cpp.
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include <weft/scenes/catalog.hpp>
#include <weft/validation/cases/support/small_systems.hpp>
#include <weft/validation/theory/scene_parts.hpp>
#include <weft/validation/theory/theory_scenes.hpp>

namespace weft::validation {
namespace {

/// A flat cloth that lies on a plane. Gravity is turned by the angle [rad] instead of the plane, downhill along x.
scenes::Scene flat_scene(double angle, double friction, double duration) {
  scenes::Scene scene = scenes::load_scene("drop_ground");
  scene.name = "flat";
  scene.summary = "Shows a flat cloth on a plane";
  scene.world = theory_world(duration, 1.0 / 1000, 3);
  scene.world.gravity = kTheoryGravity * Vector3<double>(std::sin(angle), -std::cos(angle), 0);
  scene.colliders[0].friction = 1.0;
  scenes::Cloth& cloth = scene.cloths[0];
  ClothGrid& grid = cloth.grid();
  grid.nodes = {5, 5};
  grid.size = {0.2, 0.2};
  grid.u_axis = {1, 0, 0};
  grid.total_mass = 0.01;
  grid.center = {0, cloth.collision_margin, 0};
  cloth.friction = friction;
  cloth.velocity.setZero();
  cloth.laws = {tension_law(20.0), gravity_law(scene.world.gravity)};
  return scene;
}

double way_of(const Frames& frames) {
  return frames.back().cloths[0].positions.row(0).mean() -
         frames.front().cloths[0].positions.row(0).mean();
}

Sabotage friction_scaled(double factor) {
  Sabotage sabotage{fmt::format("friction {:+.0f} %", 100 * (factor - 1))};
  sabotage.edit_scene = [factor](scenes::Scene& scene) {
    for (scenes::Cloth& cloth : scene.cloths) cloth.friction *= factor;
  };
  return sabotage;
}

void set_stiffness(scenes::Scene& scene, double stiffness) {
  for (scenes::Cloth& cloth : scene.cloths) cloth.laws[0] = tension_law(stiffness);
}

}  // namespace

std::vector<TheoryScene> incline_scenes(const CaseInfo&, const CaseOptions&) {
  constexpr double kTime = 0.5;  // [s]
  std::vector<TheoryScene> list;
  for (const double degrees : {10.0, 25.0, 35.0}) {
    constexpr double kFriction = 0.1;
    const double angle = degrees * std::numbers::pi / 180;
    const double acceleration = kTheoryGravity * (std::sin(angle) - kFriction * std::cos(angle));
    const double exact = acceleration * kTime * kTime / 2;
    TheoryBound bound;
    bound.claim =
        fmt::format("in the engine: a cloth slides down {} degrees, mu = {}", degrees, kFriction);
    bound.metric = "relative error of its way in 0.5 s";
    bound.formula = "g (sin(angle) - mu cos(angle)) t^2 / 2";
    bound.source = "Coulomb friction of a body that moves as a whole";
    bound.values = [exact](const Frames& frames) -> std::vector<ComparedValue> {
      return {{"way", way_of(frames), exact, "m"}};
    };
    bound.tolerance = [](double h) {
      return Tolerance{h / kTime + 0.01, Basis::kTruncation,
                       "a sum over steps misses the integral by h / t; 1 % for what single "
                       "precision rounds and the first contact takes"};
    };
    bound.sabotages = {friction_scaled(2.0)};
    list.push_back(
        {fmt::format("slope_{:.0f}", degrees), flat_scene(angle, kFriction, kTime), {bound}});
  }
  return list;
}

std::vector<TheoryScene> stopping_scenes(const CaseInfo&, const CaseOptions&) {
  constexpr double kSpeed = 2.0;          // [m/s]
  constexpr double kFriction = 0.3;       // [-]
  constexpr double kSoft = 20.0;          // [N/m]: what nothing pulls at needs no more
  constexpr int kNodesAcross = 15;        // of stiff sheets, which must move as one
  constexpr double kArealDensity = 0.25;  // [kg/m^2]
  const double exact = kSpeed * kSpeed / (2 * kFriction * kTheoryGravity);
  std::vector<TheoryScene> list;
  for (const double stiffness : {kSoft, 1e3, 1e5, 1e6}) {
    const bool is_stiff = stiffness > kSoft;
    TheoryBound bound;
    bound.claim = is_stiff ? fmt::format(
                                 "in the engine: a sheet of {:g} N/m thrown along the ground at 2 "
                                 "m/s stops",
                                 stiffness)
                           : "in the engine: a cloth thrown along the ground at 2 m/s stops";
    bound.metric = "relative error of its way, at 1.5 s";
    bound.formula = "v^2 / (2 mu g)";
    bound.source = "Coulomb friction of a body that moves as a whole";
    bound.values = [exact](const Frames& frames) -> std::vector<ComparedValue> {
      return {{"way", way_of(frames), exact, "m"}};
    };
    bound.tolerance = [exact](double h) {
      return Tolerance{kSpeed * h / exact + 0.005, Basis::kTruncation,
                       "v h: a sum over steps misses the integral by half of that"};
    };
    bound.sabotages = {friction_scaled(1.3), friction_removed()};
    scenes::Scene scene = flat_scene(0.0, kFriction, 1.5);
    scene.cloths[0].velocity = {kSpeed, 0, 0};
    if (!is_stiff) {
      list.push_back({"thrown", scene, {bound}});
      continue;
    }
    for (Sabotage& sabotage : bound.sabotages) {
      sabotage.edit_scene = [edit = sabotage.edit_scene](scenes::Scene& wrong) {
        edit(wrong);
        set_stiffness(wrong, kSoft);
      };
    }
    ClothGrid& grid = scene.cloths[0].grid();
    grid.nodes = {kNodesAcross, kNodesAcross};
    grid.size = {0.5, 0.5};
    grid.total_mass = kArealDensity * grid.size[0] * grid.size[1];
    set_stiffness(scene, stiffness);
    list.push_back({fmt::format("thrown_{:.0f}", stiffness), scene, {bound}, is_stiff});
  }
  return list;
}

}  // namespace weft::validation
