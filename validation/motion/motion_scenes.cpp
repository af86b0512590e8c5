#include <weft/validation/motion/motion_scenes.hpp>

#include <algorithm>
#include <cmath>

namespace weft::validation {
namespace {

using scenes::Cloth;
using scenes::Collider;
using scenes::Scene;

constexpr double kStep = 1.0 / 60;  // [s]
constexpr double kDensity = 0.2;    // [kg/m^2]

forces::LawSpecification gravity() {
  return {"gravity", {}, {{"acceleration", {0.0, -9.81, 0.0}}}};
}

forces::LawSpecification tension(double stiffness) {
  return {"tension", {}, {{"stiffness", {stiffness}}}};
}

forces::LawSpecification drag(double rate) {
  return {"velocity_damping", {}, {{"rate", {rate}}}};
}

Scene scene_of(const std::string& name, double duration) {
  Scene scene;
  scene.name = name;
  scene.summary = "Shows whether a solver moves, meets and rests as the laws say";
  scene.world.time_step = kStep;
  scene.world.frame_interval = kStep;
  scene.world.duration = duration;
  return scene;
}

/// A square sheet of the usual density.
Cloth sheet(int nodes, double size, const Vector3<double>& center) {
  ClothGrid grid;
  grid.nodes = {nodes, nodes};
  grid.size = {size, size};
  grid.center = center;
  grid.total_mass = kDensity * size * size;
  Cloth cloth;
  cloth.name = "cloth";
  cloth.source = grid;
  cloth.collision_margin = 0.005;
  return cloth;
}

Collider ball(double radius, double mass, const Vector3<double>& place,
              const Vector3<double>& velocity) {
  Collider collider{.name = "ball", .shape = scenes::SphereShape{radius}};
  collider.position = place;
  collider.mass = mass;
  collider.velocity = velocity;
  return collider;
}

Collider box(const Vector3<double>& size, const Vector3<double>& place) {
  Collider collider{.name = "box", .shape = scenes::BoxShape{size / 2}};
  collider.position = place;
  return collider;
}

Collider ground() {
  return {.name = "ground", .shape = scenes::PlaneShape{}};
}

std::vector<scenes::Pin> all_edges() {
  return {scenes::EdgePin{0, 0}, scenes::EdgePin{0, -1}, scenes::EdgePin{1, 0},
          scenes::EdgePin{1, -1}};
}

/// A sheet that hangs in the plane of x and y, and a ball on its way to it.
Scene ball_into_hanging(const std::string& name, double stiffness, double speed) {
  Scene scene = scene_of(name, 0.5);
  Cloth cloth = sheet(41, 1.0, {0, 1, 0});
  cloth.grid().v_axis = {0, -1, 0};
  cloth.laws = {gravity(), tension(stiffness), drag(0.2)};
  scene.cloths = {cloth};
  scene.colliders = {ball(0.08, 0.2, {0.02, 0.9, 0.813}, {0, 0, -speed})};
  return scene;
}

/// A sheet of 1 m and 250 g that will rest.
Scene resting_sheet(const std::string& name) {
  Scene scene = scene_of(name, 12.0);
  Cloth cloth = sheet(21, 1.0, {0, 0, 0});
  cloth.grid().total_mass = 0.25;
  cloth.laws = {gravity(), tension(50.0), drag(3.0)};
  scene.cloths = {cloth};
  return scene;
}

Scene drape_over(const std::string& name, const Collider& body) {
  Scene scene = scene_of(name, 8.0);
  Cloth cloth = sheet(31, 0.8, {0.013, 0.02, 0.007});
  cloth.laws = {gravity(), tension(50.0), drag(2.0)};
  scene.cloths = {cloth};
  scene.colliders = {body};
  return scene;
}

}  // namespace

Scene swinging_sheet(int nodes, double mass, double stiffness) {
  Scene scene = scene_of("swing", 3.0);
  Cloth cloth = sheet(nodes, 1.0, {0, 0, 0});
  ClothGrid& grid = cloth.grid();
  grid.stencil = GridStencil::k12Neighbour;
  grid.lumping = MassLumping::kUniform;
  grid.total_mass = mass;
  cloth.pins = {scenes::CornerPin{0, 0}, scenes::CornerPin{-1, 0}};
  cloth.laws = {gravity(), tension(stiffness)};
  scene.cloths = {cloth};
  return scene;
}

Scene sheet_on_edge() {
  Scene scene = scene_of("sheet_on_edge", 3.0);
  Cloth cloth = sheet(41, 0.8, {0, 0.65, 0});
  cloth.grid().v_axis = {0, -1, 0.02};
  cloth.collision_margin = 0.0065;
  cloth.laws = {gravity(), tension(300.0), drag(0.5)};
  scene.cloths = {cloth};
  scene.colliders = {ground()};
  return scene;
}

Scene sheet_over_narrow_box() {
  Scene scene = scene_of("sheet_over_narrow_box", 3.0);
  Cloth cloth = sheet(41, 1.0, {0.013, 0.8, 0.007});
  cloth.collision_margin = 0.0065;
  cloth.laws = {gravity(), tension(300.0), drag(0.5)};
  scene.cloths = {cloth};
  scene.colliders = {box({0.2, 0.4, 0.2}, {0, 0.3, 0}), ground()};
  return scene;
}

Scene ball_on_trampoline(double duration) {
  Scene scene = scene_of("ball_on_trampoline", duration);
  Cloth cloth = sheet(21, 1.0, {0, 1, 0});
  cloth.pins = all_edges();
  cloth.laws = {gravity(), tension(200.0), drag(20.0)};
  scene.cloths = {cloth};
  scene.colliders = {ball(0.12, 1.0, {0, 1.13, 0}, {0, 0, 0})};
  scene.colliders[0].friction = 0.0;
  return scene;
}

Scene box_on_tablecloth() {
  Scene scene = scene_of("box_on_tablecloth", 2.0);
  Cloth cloth = sheet(21, 0.8, {0, 0.01, 0});
  cloth.friction = 0.3;
  cloth.laws = {gravity(), tension(2000.0)};
  Collider table = box({1.2, 0.1, 1.2}, {0, -0.05, 0});
  table.name = "table";
  Collider load = box({0.2, 0.2, 0.2}, {0.03, 0.13, 0.02});
  load.mass = 1.0;
  scene.cloths = {cloth};
  scene.colliders = {load, table};
  return scene;
}

Scene ball_onto_tablecloth() {
  Scene scene = box_on_tablecloth();
  scene.name = "ball_onto_tablecloth";
  scene.colliders[0] = ball(0.1, 2.0, {0.03, 0.22, 0.02}, {0, -4, 0});
  return scene;
}

Scene ball_into_flag() {
  Scene scene = ball_into_hanging("ball_into_flag", 2000.0, 5.0);
  scene.cloths[0].pins = {scenes::EdgePin{1, 0}};
  return scene;
}

Scene ball_into_net() {
  Scene scene = ball_into_hanging("ball_into_net", 20000.0, 20.0);
  scene.cloths[0].pins = all_edges();
  return scene;
}

Scene ball_into_free_sheet(const FreeImpact& impact) {
  Scene scene = scene_of("ball_into_free_sheet", 0.3);
  scene.world.gravity.setZero();
  Cloth cloth = sheet(31, 0.8, {0, 0, 0});
  cloth.laws = {tension(2000.0)};
  const double mass = impact.mass_ratio * cloth.grid().total_mass;
  scene.cloths = {cloth};
  scene.colliders = {ball(0.1, mass, {0.03, 0.37, 0.02}, {0, -impact.speed, 0})};
  return scene;
}

Scene hammock() {
  Scene scene = resting_sheet("hammock");
  const auto edge = [](int side, double inwards) {
    scenes::MovingPin pin{.nodes = scenes::EdgePin{0, side}};
    scenes::Path path;
    path.times = {0.0, 1.0};
    path.points = {{0, 0, 0}, {inwards, 0, 0}};
    pin.path = path;
    return pin;
  };
  scene.cloths[0].moving_pins = {edge(0, 0.1), edge(-1, -0.1)};
  return scene;
}

Scene banner() {
  Scene scene = resting_sheet("banner");
  scene.cloths[0].pins = {scenes::EdgePin{0, 0}};
  return scene;
}

Scene drape_over_box() {
  return drape_over("drape_over_box", box({0.3, 0.4, 0.3}, {0, -0.2, 0}));
}

Scene drape_over_ball() {
  Collider sphere{.name = "ball", .shape = scenes::SphereShape{0.2}};
  sphere.position = {0, -0.2, 0};
  return drape_over("drape_over_ball", sphere);
}

Scene clamped_strip(const Strip& strip) {
  Scene scene = scene_of(strip.name, strip.duration);
  ClothGrid grid;
  grid.nodes = {strip.nodes, strip.rows};
  grid.size = {strip.length, strip.width};
  grid.total_mass = strip.areal_density * strip.length * strip.width;
  Cloth cloth;
  cloth.name = "strip";
  cloth.collision_margin = 0.001;
  scenes::NodePin clamp;
  for (int j = 0; j < strip.rows; ++j) {
    for (const int i : {0, 1}) clamp.nodes.push_back(j * strip.nodes + i);
  }
  cloth.source = grid;
  cloth.pins = {clamp};
  cloth.laws = {gravity(),
                tension(500.0),
                {"hinge_torsion", {}, {{"rigidity", {strip.rigidity}}}},
                drag(4.0)};
  scene.cloths = {cloth};
  return scene;
}

std::vector<Strip> typical_strips() {
  return {{"stiff_denim_5mm", 0.3, 0.1, 61, 21, 0.3, 3e-4, 8.0},
          {"cotton_2mm", 0.1, 0.025, 41, 11, 0.15, 2.34e-6, 5.0},
          {"denim_5mm", 0.2, 0.05, 41, 11, 0.4, 1e-4, 5.0},
          {"paper_5mm", 0.2, 0.05, 41, 11, 0.08, 3e-4, 5.0},
          {"leather_10mm", 0.3, 0.1, 31, 11, 0.9, 2e-3, 5.0}};
}

Scene with_step(Scene scene, double time_step, double frame_interval) {
  const double steps_per_frame = std::max(1.0, std::round(frame_interval / time_step));
  scene.world.time_step = time_step;
  scene.world.frame_interval = steps_per_frame * time_step;
  scene.world.duration =
      std::round(scene.world.duration / scene.world.frame_interval) * scene.world.frame_interval;
  return scene;
}

}  // namespace weft::validation
