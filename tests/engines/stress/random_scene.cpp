#include "tests/engines/stress/random_scene.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include <weft/custom_forces/registry.hpp>

namespace weft::scenes::stress {
namespace {

/// Numbers of a seed. The standard's distributions differ between libraries, its generator does not.
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : generator_(seed) {}

  double part() { return static_cast<double>(generator_() >> 11) * 0x1p-53; }  // [0, 1)
  bool chance(double probability) { return part() < probability; }
  int below(int n) { return static_cast<int>(part() * n); }
  int between(int low, int high) { return low + below(high - low + 1); }
  double uniform(double low, double high) { return low + (high - low) * part(); }
  /// Every power of ten is as likely as every other one.
  double magnitude(double low, double high) { return low * std::pow(high / low, part()); }
  /// Ordinary for most, of the wide range for the others.
  double magnitude(double low, double high, double widest_low, double widest_high) {
    return chance(0.7) ? magnitude(low, high) : magnitude(widest_low, widest_high);
  }
  Vector3<double> direction() {
    Vector3<double> vector;
    do {
      for (double& x : vector) x = uniform(-1, 1);
    } while (!(vector.norm() > 0.1));
    return vector.normalized();
  }

 private:
  std::mt19937_64 generator_;
};

double length(Dice& dice) {
  return dice.magnitude(0.1, 3, 1e-6, 1e3);
}
double mass(Dice& dice) {
  return dice.magnitude(0.01, 10, 1e-6, 1e6);
}

Vector3<double> velocity(Dice& dice) {
  if (dice.chance(0.5)) return Vector3<double>::Zero();
  return dice.magnitude(0.01, 10, 1e-3, 1e5) * dice.direction();
}

ClothSource source(Dice& dice, const Vector3<double>& center) {
  const MassLumping lumping = dice.chance(0.5) ? MassLumping::kArea : MassLumping::kUniform;
  switch (dice.below(5)) {
    case 0: {
      Icosphere sphere;
      sphere.radius = length(dice);
      sphere.frequency = dice.between(1, 3);
      sphere.center = center;
      sphere.total_mass = mass(dice);
      sphere.lumping = lumping;
      if (dice.chance(0.3)) sphere.center_mass_share = dice.uniform(0.01, 0.9);
      return sphere;
    }
    case 1: {
      Rope rope;
      rope.nodes = dice.between(2, 40);
      rope.start = center;
      rope.end = center + length(dice) * dice.direction();
      rope.total_mass = mass(dice);
      rope.lumping = lumping;
      return rope;
    }
    default: {
      ClothGrid grid;
      grid.nodes = {dice.between(2, 14), dice.between(2, 14)};
      grid.size = {length(dice), length(dice)};
      grid.center = center;
      grid.stencil = static_cast<GridStencil>(dice.below(3));
      grid.total_mass = mass(dice);
      grid.lumping = lumping;
      return grid;
    }
  }
}

double parameter_value(Dice& dice, const forces::ParameterInfo& info) {
  if (!info.required && dice.chance(0.3)) return info.default_value;
  if (info.maximum <= 100.0) {  // a ratio
    const double part = dice.chance(0.2) ? std::round(dice.part()) : dice.part();
    return info.minimum + part * (info.maximum - info.minimum);
  }
  if (dice.chance(0.1)) return std::max(0.0, info.minimum);
  const double value = dice.magnitude(1e-3, 1e3, 1e-9, 1e9);
  const bool is_negative = info.minimum < 0.0 && dice.chance(0.5);
  return std::clamp(is_negative ? -value : value, info.minimum, info.maximum);
}

forces::LawSpecification law(Dice& dice, const forces::LawInfo& info, bool has_links) {
  forces::LawSpecification result{std::string(info.id), {}, {}};
  if (info.traits.elements == forces::ElementKind::kNodeSets) result.sets = {"region"};
  if (info.traits.elements == forces::ElementKind::kConnections) result.sets = {"tie"};
  for (const forces::ParameterInfo& parameter : info.parameters) {
    std::vector<double> values;
    if (parameter.size == 3) {
      const Vector3<double> vector = dice.magnitude(0.1, 10, 1e-3, 1e4) * dice.direction();
      values.assign(vector.begin(), vector.end());
    } else if (has_links && parameter.name == "compression_ratio") {
      values = {1.0};
    } else {
      values = {parameter_value(dice, parameter)};
    }
    result.parameters.emplace(parameter.name, values);
  }
  return result;
}

bool is_possible(const forces::LawInfo& info, const ClothSource& source, std::string_view engine) {
  const bool is_deformable = engine.substr(0, 17) == "bullet_deformable";
  if (is_deformable && info.traits.level == forces::LawTraits::Level::kInertia) return false;
  if (info.traits.needs_closed_surface && !std::holds_alternative<Icosphere>(source)) return false;
  const forces::ElementKind elements = info.traits.elements;
  const bool needs_sets = !forces::set_key(elements).empty() &&
                          elements != forces::ElementKind::kNodeSets &&
                          elements != forces::ElementKind::kConnections;
  if (needs_sets && source_sets(source, elements).empty()) return false;
  const bool needs_faces = elements == forces::ElementKind::kHinges ||
                           elements == forces::ElementKind::kFaces ||
                           elements == forces::ElementKind::kConnections;
  return !needs_faces || !std::holds_alternative<Rope>(source);
}

Cloth cloth(Dice& dice, std::string_view engine, int number) {
  Cloth result;
  result.name = "cloth_" + std::to_string(number);
  result.source =
      source(dice, {dice.uniform(-0.2, 0.2), dice.uniform(0.0, 1.0), dice.uniform(-0.2, 0.2)});
  const int nodes = num_nodes(result.source);
  result.velocity = velocity(dice);
  if (dice.chance(0.3)) result.pins.push_back(NodePin{{dice.below(nodes)}});
  if (dice.chance(0.5)) result.collision_margin = dice.magnitude(1e-3, 0.03, 1e-6, 0.3);
  result.friction = dice.chance(0.5) ? 0.5 : dice.uniform(0, 2);
  if (engine.substr(0, 17) != "bullet_deformable") {
    result.self_collision = dice.chance(0.25);
    result.soft_collision = dice.chance(0.25);
    if (dice.chance(0.1)) {
      result.tear.emplace();
      result.tear->rule.strain = dice.magnitude(1e-3, 10);
    }
  }
  result.regions.push_back({.name = "region", .nodes = {NodePin{{dice.below(nodes)}}}});
  if (std::holds_alternative<ClothGrid>(result.source)) {
    result.connections.push_back({.name = "tie", .to = {}, .node_number = dice.below(nodes)});
  }
  const auto all = forces::all_laws();
  const int num_laws = dice.between(1, 6);
  std::vector<const forces::LawInfo*> chosen;
  if (dice.chance(0.7)) chosen.push_back(forces::find_law("tension"));
  for (int i = 0; i < num_laws; ++i) {
    const forces::LawInfo* info =
        all[static_cast<std::size_t>(dice.below(static_cast<int>(all.size())))];
    const bool is_new = std::find(chosen.begin(), chosen.end(), info) == chosen.end();
    const bool is_tied = info->traits.elements == forces::ElementKind::kConnections;
    if (!is_new || !is_possible(*info, result.source, engine)) continue;
    if (is_tied && result.connections.empty()) continue;
    chosen.push_back(info);
  }
  for (const forces::LawInfo* info : chosen) {
    result.laws.push_back(law(dice, *info, engine == "bullet_soft"));
  }
  return result;
}

Collider collider(Dice& dice, int number) {
  Collider result;
  result.name = "collider_" + std::to_string(number);
  bool may_have_mass = true;
  switch (dice.below(6)) {
    case 0:
      result.shape = SphereShape{length(dice)};
      break;
    case 1:
      result.shape = BoxShape{{length(dice), length(dice), length(dice)}};
      break;
    case 2:
      result.shape = CapsuleShape{length(dice), length(dice)};
      break;
    case 3:
      result.shape = CylinderShape{length(dice), length(dice)};
      break;
    case 4:
      result.shape = ConeShape{length(dice), length(dice)};
      may_have_mass = false;
      break;
    default:
      result.shape = PlaneShape{};
      may_have_mass = false;
      break;
  }
  result.position = {dice.uniform(-0.3, 0.3), dice.uniform(-1, 0.5), dice.uniform(-0.3, 0.3)};
  result.orientation = Eigen::AngleAxisd(dice.uniform(0, 3), dice.direction());
  result.friction = dice.uniform(0, 2);
  if (may_have_mass && dice.chance(0.6)) {
    result.mass = mass(dice);
    result.velocity = velocity(dice);
    if (dice.chance(0.6)) {
      const double speed =
          dice.chance(0.05) ? dice.magnitude(1e6, 1e200) : dice.magnitude(0.1, 1e5);
      result.angular_velocity = speed * dice.direction();
    }
  }
  return result;
}

ReferenceSettings reference_settings(Dice& dice) {
  ReferenceSettings result;
  result.integrator = static_cast<Integrator>(dice.below(10));
  result.contact = static_cast<ContactModel>(dice.below(2));
  result.contact_points = static_cast<ContactPoints>(dice.below(2));
  result.step_guard = dice.chance(0.2) ? StepGuard::kSubstep : StepGuard::kReport;
  result.spectral_radius = dice.part();
  return result;
}

}  // namespace

Scene random_scene(std::uint64_t seed, std::string_view engine) {
  Dice dice(seed);
  Scene scene;
  scene.name = "stress_" + std::to_string(seed);
  scene.summary = "Shows what an engine does with random numbers.";
  if (dice.chance(0.3)) scene.world.gravity = dice.magnitude(0.1, 1e3) * dice.direction();
  scene.world.time_step = dice.magnitude(1e-5, 0.1);
  scene.world.duration = dice.between(3, 12) * scene.world.time_step;
  scene.world.frame_interval = scene.world.time_step;
  scene.bullet.position_iterations = dice.between(1, 20);
  scene.reference = reference_settings(dice);
  const int num_cloths = dice.chance(0.7) ? 1 : 2;
  for (int i = 0; i < num_cloths; ++i) scene.cloths.push_back(cloth(dice, engine, i));
  const int num_colliders = dice.below(4);
  for (int i = 0; i < num_colliders; ++i) scene.colliders.push_back(collider(dice, i));
  return scene;
}

}  // namespace weft::scenes::stress
