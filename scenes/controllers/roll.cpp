#include <weft/scenes/controllers/roll.hpp>

#include <algorithm>
#include <cmath>

#include <weft/core/error.hpp>

namespace weft::scenes {

RollController::RollController(const Roll& roll, std::size_t cloth, const ClothMesh& mesh)
    : roll_(roll), target_(roll.target), cloth_(cloth), masses_(mesh.masses) {
  if (!(roll.turn_rate > 0 && roll.arrival > 0 && roll.torque >= 0)) {
    throw InvalidArgument("roll: turn_rate and arrival, expected > 0; torque, expected >= 0");
  }
}

void RollController::steer(const SceneState& state, double end_time, StepCommands& commands) {
  const ClothState& cloth = state.cloths[cloth_];
  const double mass = masses_.sum();
  const Vector3<double> center = cloth.positions * masses_ / mass;
  const Vector3<double> velocity = cloth.velocities * masses_ / mass;
  Vector3<double> way = target_.position(end_time) - center;
  way.y() = 0;
  const double distance = way.norm();
  if (!(distance > 0)) return;
  const Vector3<double> axis = Vector3<double>::UnitY().cross(way / distance);

  double inertia = 0;   // about axis [kg m^2]
  double momentum = 0;  // [kg m^2/s]
  for (Eigen::Index i = 0; i < masses_.size(); ++i) {
    const Vector3<double> arm = cloth.positions.col(i) - center;
    inertia += masses_[i] * axis.cross(arm).squaredNorm();
    momentum += masses_[i] * axis.dot(arm.cross(cloth.velocities.col(i) - velocity));
  }
  if (!(inertia > 0)) return;
  const double wanted = roll_.turn_rate * std::min(1.0, distance / roll_.arrival);
  const double torque =
      roll_.torque * std::clamp((wanted - momentum / inertia) / roll_.turn_rate, -1.0, 1.0);

  Matrix3X<double>& forces = commands.cloths[cloth_].node_forces;
  if (forces.cols() == 0) forces = Matrix3X<double>::Zero(3, cloth.positions.cols());
  for (Eigen::Index i = 0; i < masses_.size(); ++i) {
    const Vector3<double> arm = cloth.positions.col(i) - center;
    forces.col(i) += torque / inertia * masses_[i] * axis.cross(arm);
  }
}

}  // namespace weft::scenes
