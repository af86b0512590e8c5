#include <weft/validation/theory/scene_parts.hpp>

#include <cmath>
#include <utility>

#include <fmt/format.h>

#include <weft/core/error.hpp>
#include <weft/validation/cases/support/small_systems.hpp>

namespace weft::validation {

scenes::World theory_world(double duration, double longest_step, int frames_apart) {
  constexpr double kFrame = 1.0 / 30;  // [s], the longest step of kTheoryStepsPerSecond
  scenes::World world;
  const double steps = std::max(1.0, std::ceil(kFrame / longest_step));
  world.time_step = kFrame / steps;
  world.frame_interval = frames_apart * kFrame;
  world.duration = std::ceil(duration / world.frame_interval - 1e-9) * world.frame_interval;
  return world;
}

scenes::Cloth rope_cloth(const RopeParts& parts) {
  scenes::Cloth cloth;
  cloth.name = "rope";
  Rope rope;
  rope.nodes = parts.springs + 1;
  rope.start = parts.start;
  rope.end = parts.end;
  rope.total_mass = parts.node_mass * rope.nodes;
  rope.lumping = MassLumping::kUniform;
  cloth.source = rope;
  cloth.collision_margin = 1e-3;
  cloth.pins = {scenes::NodePin{parts.pinned}};
  forces::LawSpecification tension = tension_law(parts.stiffness);
  tension.sets = {"stretch"};
  cloth.laws = {tension};
  if (parts.has_gravity) cloth.laws.push_back(gravity_law({0, -kTheoryGravity, 0}));
  if (parts.rate > 0) cloth.laws.push_back(velocity_damping_law(parts.rate));
  if (parts.damping > 0) {
    forces::LawSpecification damper = spring_damping_law(parts.damping);
    damper.sets = {"stretch"};
    cloth.laws.push_back(damper);
  }
  return cloth;
}

scenes::Scene theory_scene(const std::string& name, const scenes::World& world, scenes::Cloth cloth,
                           bool has_gravity) {
  scenes::Scene scene;
  scene.name = name;
  scene.summary = "Shows a body of which a theory knows a number";
  scene.world = world;
  scene.world.gravity = {0, has_gravity ? -kTheoryGravity : 0.0, 0};
  scene.cloths.push_back(std::move(cloth));
  return scene;
}

scenes::MovingPin led_node(int node, const Vector3<double>& from, const Vector3<double>& to,
                           double time) {
  scenes::MovingPin pin;
  pin.nodes = scenes::NodePin{{node}};
  scenes::Path path;
  path.times = {0.0, time};
  path.points = {from, to};
  pin.path = path;
  return pin;
}

Sabotage law_scaled(const std::string& name, const std::string& law, const std::string& parameter,
                    double factor) {
  Sabotage sabotage{name};
  sabotage.edit_scene = [law, parameter, factor](scenes::Scene& scene) {
    for (scenes::Cloth& cloth : scene.cloths) {
      for (forces::LawSpecification& each : cloth.laws) {
        if (each.law != law) continue;
        for (double& value : each.parameters.at(parameter)) value *= factor;
      }
    }
  };
  return sabotage;
}

Sabotage drag_added(double rate) {
  Sabotage sabotage{fmt::format("a drag of {:.3g} 1/s on every node", rate)};
  sabotage.edit_scene = [rate](scenes::Scene& scene) {
    for (scenes::Cloth& cloth : scene.cloths) cloth.laws.push_back(velocity_damping_law(rate));
  };
  return sabotage;
}

void refuse_values(const CaseInfo& info, const CaseOptions& options,
                   const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    if (!options.values.contains(name)) continue;
    throw InvalidArgument(fmt::format(
        "validate: case '{}': {} = {} is for the engine 'reference' alone, not for '{}'", info.id,
        name, options.values.at(name), options.engine));
  }
}

}  // namespace weft::validation
