#include <weft/scenes/controllers/seek.hpp>

#include <algorithm>
#include <cmath>
#include <string>

#include <weft/core/error.hpp>

namespace weft::scenes {
namespace {

void require_seek(bool ok, const std::string& message) {
  if (!ok) throw InvalidArgument("seek: " + message);
}

Vector3<double> horizontal(Vector3<double> v) {
  v.y() = 0;
  return v;
}

/// Angle about the vertical, from a to b, -pi to pi [rad].
double angle_between(const Vector3<double>& a, const Vector3<double>& b) {
  return std::atan2(a.z() * b.x() - a.x() * b.z(), a.x() * b.x() + a.z() * b.z());
}

}  // namespace

/// The motion of the region, about the vertical.
struct SeekController::Motion {
  Vector3<double> center{0, 0, 0};    ///< [m]
  Vector3<double> velocity{0, 0, 0};  ///< [m/s]
  double angle = 0.0;                 ///< turned since the start [rad]
  double rate = 0.0;                  ///< [rad/s]
  double inertia = 0.0;               ///< [kg m^2]
};

SeekController::SeekController(const Seek& seek, std::size_t cloth, const ClothMesh& mesh)
    : seek_(seek), target_(seek.target), cloth_(cloth) {
  require_seek(seek.speed > 0 && seek.turn_rate > 0 && seek.arrival > 0,
               "speed, turn_rate and arrival, expected > 0");
  require_seek(seek.force >= 0 && seek.torque >= 0, "force and torque, expected >= 0");
  require_seek(horizontal(seek.front).norm() > 0, "front has no horizontal part");
  for (const NodeSet& set : mesh.node_sets) {
    if (set.name == seek.region) nodes_ = set.nodes;
  }
  require_seek(!nodes_.empty(), "region = '" + seek.region + "', expected a region of the cloth '" +
                                    seek.cloth + "'");
  Vector3<double> center(0, 0, 0);
  for (const int node : nodes_) {
    masses_.push_back(mesh.masses[node]);
    total_mass_ += masses_.back();
    center += masses_.back() * mesh.rest_positions.col(node);
  }
  center /= total_mass_;
  for (const int node : nodes_) arms_.emplace_back(mesh.rest_positions.col(node) - center);
}

SeekController::Motion SeekController::motion_of(const ClothState& cloth) const {
  Motion motion;
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    motion.center += masses_[i] / total_mass_ * cloth.positions.col(nodes_[i]);
    motion.velocity += masses_[i] / total_mass_ * cloth.velocities.col(nodes_[i]);
  }
  double sine = 0;
  double cosine = 0;
  double momentum = 0;
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    const Vector3<double> arm = horizontal(cloth.positions.col(nodes_[i]) - motion.center);
    const Vector3<double> velocity = cloth.velocities.col(nodes_[i]) - motion.velocity;
    const Vector3<double>& rest = arms_[i];
    // The turn that brings the arms at rest closest to those of now.
    sine += masses_[i] * (rest.z() * arm.x() - rest.x() * arm.z());
    cosine += masses_[i] * (rest.x() * arm.x() + rest.z() * arm.z());
    momentum += masses_[i] * (arm.z() * velocity.x() - arm.x() * velocity.z());
    motion.inertia += masses_[i] * arm.squaredNorm();
  }
  motion.angle = std::atan2(sine, cosine);
  if (motion.inertia > 0) motion.rate = momentum / motion.inertia;
  return motion;
}

void SeekController::steer(const SceneState& state, double end_time, StepCommands& commands) {
  const ClothState& cloth = state.cloths[cloth_];
  const Motion motion = motion_of(cloth);
  const Vector3<double> way = horizontal(target_.position(end_time) - motion.center);
  const double distance = way.norm();

  Vector3<double> wanted(0, 0, 0);
  if (distance > 0) wanted = seek_.speed * std::min(1.0, distance / seek_.arrival) / distance * way;
  Vector3<double> push = (wanted - horizontal(motion.velocity)) / seek_.speed;
  if (push.norm() > 1) push.normalize();

  // There is no direction to the target from where it is: within its arrival it turns less and less.
  const double near = std::min(1.0, distance / seek_.arrival);
  const Vector3<double> front =
      Eigen::AngleAxisd(motion.angle, Vector3<double>::UnitY()) * seek_.front;
  const double angle = near * angle_between(front, way);
  const double wanted_rate = seek_.turn_rate * std::clamp(angle / kEase, -1.0, 1.0);
  const double turn =
      seek_.torque * std::clamp((wanted_rate - motion.rate) / seek_.turn_rate, -1.0, 1.0);

  Matrix3X<double>& forces = commands.cloths[cloth_].node_forces;
  if (forces.cols() == 0) forces = Matrix3X<double>::Zero(3, cloth.positions.cols());
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    const Vector3<double> arm = horizontal(cloth.positions.col(nodes_[i]) - motion.center);
    forces.col(nodes_[i]) += masses_[i] / total_mass_ * seek_.force * push;
    if (motion.inertia > 0) {
      forces.col(nodes_[i]) +=
          turn * masses_[i] / motion.inertia * Vector3<double>::UnitY().cross(arm);
    }
  }
}

}  // namespace weft::scenes
