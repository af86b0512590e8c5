#include <weft/validation/metrics/energy.hpp>

#include <limits>
#include <variant>

#include <fmt/core.h>
#include <Eigen/Geometry>

#include <weft/core/error.hpp>
#include <weft/custom_forces/registry.hpp>
#include <weft/scenes/shapes/shape_surface.hpp>

namespace weft::validation {
namespace {

/// Principal moments of a homogeneous solid [kg m^2].
Vector3<double> inertia(const scenes::Collider& collider) {
  const double mass = *collider.mass;
  if (const auto* sphere = std::get_if<scenes::SphereShape>(&collider.shape)) {
    return Vector3<double>::Constant(0.4 * mass * sphere->radius * sphere->radius);
  }
  if (const auto* box = std::get_if<scenes::BoxShape>(&collider.shape)) {
    const Vector3<double> squared = box->half_extents.cwiseAbs2();
    return mass / 3.0 * (squared.sum() - squared.array());
  }
  if (std::holds_alternative<scenes::PlaneShape>(collider.shape)) {
    throw InvalidArgument(fmt::format(
        "energy: collider '{}' = a plane of {} [kg], expected no mass", collider.name, mass));
  }
  return mass * scenes::solid_moments(collider.shape).inertia;
}

bool all_finite(const scenes::SceneState& state) {
  for (const scenes::ClothState& cloth : state.cloths) {
    if (!cloth.positions.allFinite() || !cloth.velocities.allFinite()) return false;
  }
  for (const scenes::RigidState& rigid : state.rigids) {
    if (!rigid.position.allFinite() || !rigid.orientation.coeffs().allFinite() ||
        !rigid.velocity.allFinite() || !rigid.angular_velocity.allFinite()) {
      return false;
    }
  }
  return true;
}

Energy not_a_number() {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  const Vector3<double> nowhere = Vector3<double>::Constant(kNaN);
  return {kNaN, kNaN, kNaN, kNaN, kNaN, nowhere, nowhere, nowhere, false};
}

}  // namespace

SceneEnergy::SceneEnergy(const scenes::Scene& scene)
    : gravity_(scene.world.gravity), num_colliders_(scene.colliders.size()) {
  for (const scenes::Cloth& cloth : scene.cloths) {
    const ClothMesh mesh = scenes::make_mesh(cloth);
    ClothPart part{mesh.masses, {}};
    for (const forces::LawSpecification& law : cloth.laws) {
      part.laws.push_back(forces::make_law<double>(law, mesh));
    }
    mass_ += mesh.masses.sum();
    cloths_.push_back(std::move(part));
  }
  for (std::size_t i = 0; i < scene.colliders.size(); ++i) {
    if (!scene.colliders[i].mass) continue;
    rigids_.push_back({i, *scene.colliders[i].mass, inertia(scene.colliders[i])});
    mass_ += *scene.colliders[i].mass;
  }
}

void SceneEnergy::check(const scenes::SceneState& state) const {
  if (state.cloths.size() != cloths_.size() || state.rigids.size() != num_colliders_) {
    throw InvalidArgument(
        fmt::format("energy: state = {} cloths and {} rigid bodies, expected {} and {}",
                    state.cloths.size(), state.rigids.size(), cloths_.size(), num_colliders_));
  }
  for (std::size_t i = 0; i < cloths_.size(); ++i) {
    const Eigen::Index expected = cloths_[i].masses.size();
    const scenes::ClothState& cloth = state.cloths[i];
    if (cloth.positions.cols() != expected || cloth.velocities.cols() != expected) {
      throw InvalidArgument(
          fmt::format("energy: cloth {} = {} positions and {} velocities, expected {} of each", i,
                      cloth.positions.cols(), cloth.velocities.cols(), expected));
    }
  }
}

void SceneEnergy::add_cloth(const ClothPart& part, const scenes::ClothState& state, double time,
                            Energy& energy) {
  for (Eigen::Index i = 0; i < part.masses.size(); ++i) {
    const Vector3<double> position = state.positions.col(i);
    const Vector3<double> momentum = part.masses[i] * state.velocities.col(i);
    energy.kinetic_cloths += 0.5 * momentum.dot(state.velocities.col(i));
    energy.momentum += momentum;
    energy.angular_momentum += position.cross(momentum);
    energy.center_of_mass += part.masses[i] * position;
  }
  const forces::State<double> law_state{state.positions, state.velocities, part.masses, time};
  for (const auto& law : part.laws) {
    const bool is_gravity = law->info().traits.role == forces::LawRole::kGravity;
    double& store = is_gravity ? energy.gravitational : energy.elastic;
    store += law->potential_energy(law_state);
    energy.non_conservative_power += law->non_conservative_power(law_state);
  }
}

void SceneEnergy::add_rigid(const RigidPart& part, const scenes::RigidState& state,
                            Energy& energy) const {
  const Eigen::Quaterniond orientation = state.orientation.normalized();
  const Vector3<double> body_rate = orientation.conjugate() * state.angular_velocity;
  const Vector3<double> spin =
      orientation * Vector3<double>(part.body_inertia.cwiseProduct(body_rate));
  const Vector3<double> momentum = part.mass * state.velocity;
  energy.kinetic_rigids +=
      0.5 * momentum.dot(state.velocity) + 0.5 * spin.dot(state.angular_velocity);
  energy.gravitational -= part.mass * gravity_.dot(state.position);
  energy.momentum += momentum;
  energy.angular_momentum += state.position.cross(momentum) + spin;
  energy.center_of_mass += part.mass * state.position;
}

Energy SceneEnergy::evaluate(const scenes::SceneState& state) const {
  check(state);
  if (!all_finite(state)) return not_a_number();
  Energy energy;
  for (std::size_t i = 0; i < cloths_.size(); ++i)
    add_cloth(cloths_[i], state.cloths[i], state.time, energy);
  for (const RigidPart& part : rigids_) add_rigid(part, state.rigids[part.index], energy);
  energy.center_of_mass /= mass_;  // 0 / 0 without any mass, as documented
  return energy;
}

}  // namespace weft::validation
