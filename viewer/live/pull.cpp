#include <weft/viewer/live/pull.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace weft::viewer {
namespace {

constexpr double kPullGravity = 9.81;  // [m/s^2]
constexpr double kLargestInWeights = 3.0;
/// Of the critically damped spring between the mouse and a collider with a mass.
constexpr double kCarryRate = 12.0;  // [1/s]
/// Part of m / h^2 that the spring has, which an explicit step takes without ringing.
constexpr double kStiffnessShare = 0.1;
/// The pull is shared out over nodes within this part of the cloth's size, by their masses: a single
/// light node would be torn out of its neighbors.
constexpr double kPatchRadius = 0.06;

double size_of(const ClothMesh& mesh) {
  return (mesh.rest_positions.rowwise().maxCoeff() - mesh.rest_positions.rowwise().minCoeff())
      .norm();
}

}  // namespace

WindowForces::WindowForces(const scenes::Scene& scene, double time_step) : time_step_(time_step) {
  for (const scenes::Cloth& cloth : scene.cloths) meshes_.push_back(scenes::make_mesh(cloth));
  for (const scenes::Collider& collider : scene.colliders) {
    rigid_masses_.push_back(collider.mass.value_or(0.0));
    at_rest_.push_back({collider.position, collider.orientation});
  }
  moved_.assign(at_rest_.size(), Vector3<double>(0, 0, 0));
}

void WindowForces::set_carry(const std::optional<Carry>& carry) {
  const std::lock_guard lock(mutex_);
  carry_ = carry;
}

void WindowForces::serialize(StateArchive& archive) {
  const std::lock_guard lock(mutex_);
  archive.part("moved colliders");
  archive.list(moved_, [&](Vector3<double>& way) { archive.value(way); });
}

void WindowForces::carry(std::size_t collider, double time_step, const scenes::SceneState& state,
                         scenes::StepCommands& commands) {
  const bool is_carried = carry_ && carry_->collider == collider;
  const double mass = rigid_masses_[collider];
  Vector3<double>& moved = moved_[collider];
  if (mass > 0.0) {
    if (!is_carried) return;
    const scenes::RigidState& rigid = state.rigids.at(collider);
    Vector3<double> force = mass * (kCarryRate * kCarryRate * (carry_->target - rigid.position) -
                                    2.0 * kCarryRate * rigid.velocity);
    const double largest = kLargestInWeights * kPullGravity * mass;
    if (!force.allFinite()) return;
    if (force.norm() > largest) force *= largest / force.norm();
    commands.pushes[collider].force += force;
    pull_force_ = force.norm();
    return;
  }
  if (!is_carried && moved.isZero(0.0)) return;
  scenes::Pose pose = commands.colliders[collider].value_or(at_rest_[collider]);
  if (is_carried) {
    const Vector3<double> way = carry_->target - pose.position - moved;
    const double longest = kCarrySpeed * time_step;
    moved += way.norm() > longest ? (longest / way.norm() * way).eval() : way;
  }
  pose.position += moved;
  commands.colliders[collider] = pose;
}

void WindowForces::set_pull(const std::optional<Pull>& pull) {
  const std::lock_guard lock(mutex_);
  pull_ = pull;
}

void WindowForces::set_added_gravity(const Vector3<double>& acceleration) {
  const std::lock_guard lock(mutex_);
  added_gravity_ = acceleration;
}

double WindowForces::pull_force() const {
  const std::lock_guard lock(mutex_);
  return pull_force_;
}

double WindowForces::largest_force(std::size_t cloth) const {
  return kLargestInWeights * kPullGravity * meshes_.at(cloth).masses.sum();
}

void WindowForces::steer(const scenes::SceneState& state, double end_time,
                         scenes::StepCommands& commands) {
  const std::lock_guard lock(mutex_);
  pull_force_ = 0.0;
  if (pull_) pull(*pull_, state, commands);
  for (std::size_t k = 0; k < moved_.size(); ++k) carry(k, end_time - state.time, state, commands);
  if (added_gravity_.isZero(0.0)) return;
  for (std::size_t k = 0; k < commands.pushes.size(); ++k) {
    commands.pushes[k].force += rigid_masses_[k] * added_gravity_;
  }
}

void WindowForces::pull(const Pull& pull, const scenes::SceneState& state,
                        scenes::StepCommands& commands) {
  const ClothMesh& mesh = meshes_.at(pull.id.cloth);
  const scenes::ClothState& cloth = state.cloths.at(pull.id.cloth);
  // The masses of nodes that a tear has made are not known here.
  if (pull.id.node >= mesh.num_nodes()) return;
  const double radius = kPatchRadius * size_of(mesh);
  const Vector3<double> rest = mesh.rest_positions.col(pull.id.node);
  std::vector<int> patch;
  double mass = 0.0;
  for (int i = 0; i < mesh.num_nodes(); ++i) {
    if ((mesh.rest_positions.col(i) - rest).norm() > radius) continue;
    if (std::binary_search(mesh.pinned.begin(), mesh.pinned.end(), i)) continue;
    patch.push_back(i);
    mass += mesh.masses[i];
  }
  if (patch.empty()) return;
  const double stiffness = kStiffnessShare * mass / (time_step_ * time_step_);  // [N/m]
  // Critical for the patch, but at most what one step can take away.
  const double damping =
      std::min(2.0 * std::sqrt(stiffness * mass), 0.5 * mass / time_step_);  // [N s/m]
  Vector3<double> force = stiffness * (pull.target - cloth.positions.col(pull.id.node)) -
                          damping * cloth.velocities.col(pull.id.node);
  const double largest = largest_force(pull.id.cloth);
  if (!force.allFinite()) return;
  if (force.norm() > largest) force *= largest / force.norm();
  Matrix3X<double>& forces = commands.cloths[pull.id.cloth].node_forces;
  if (forces.cols() == 0) forces = Matrix3X<double>::Zero(3, cloth.positions.cols());
  for (const int i : patch) forces.col(i) += mesh.masses[i] / mass * force;
  pull_force_ = force.norm();
}

}  // namespace weft::viewer
