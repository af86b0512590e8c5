#include <weft/engines/blow_up_check.hpp>

#include <utility>

#include <fmt/format.h>

namespace weft::scenes {
namespace {

using Fault = std::optional<std::string>;

Fault fault_of_position(const Vector3<double>& position, double reach) {
  if (!position.allFinite()) return "position is not finite";
  const double distance = position.cwiseAbs().maxCoeff();
  if (distance <= reach) return std::nullopt;
  return fmt::format("position {:.3g} m from the origin is beyond the {:.3g} m of the engine",
                     distance, reach);
}

Fault fault_of_velocity(const Vector3<double>& velocity) {
  if (!velocity.allFinite()) return "velocity is not finite";
  const double speed = velocity.norm();
  if (speed <= kMaxNodeSpeed) return std::nullopt;
  return fmt::format("speed {:.3g} m/s is over {:.3g} m/s", speed, kMaxNodeSpeed);
}

Fault fault_of(const RigidState& rigid, double reach) {
  if (Fault fault = fault_of_position(rigid.position, reach)) return fault;
  if (!rigid.orientation.coeffs().allFinite()) return "orientation is not finite";
  return fault_of_motion(rigid.velocity, rigid.angular_velocity);
}

}  // namespace

Fault fault_of_motion(const Vector3<double>& velocity, const Vector3<double>& angular_velocity) {
  if (Fault fault = fault_of_velocity(velocity)) return fault;
  if (!angular_velocity.allFinite()) return "angular velocity is not finite";
  const double speed = angular_velocity.norm();
  if (speed <= kMaxAngularSpeed) return std::nullopt;
  return fmt::format("angular speed {:.3g} rad/s is over {:.3g} rad/s", speed, kMaxAngularSpeed);
}

std::optional<BlowUp> first_blow_up(const SceneState& state, int step, double time, double reach) {
  for (const ClothState& cloth : state.cloths) {
    for (Eigen::Index i = 0; i < cloth.positions.cols(); ++i) {
      Fault fault = fault_of_position(cloth.positions.col(i), reach);
      if (!fault) fault = fault_of_velocity(cloth.velocities.col(i));
      if (fault) return BlowUp{step, time, cloth.name, static_cast<int>(i), std::move(*fault)};
    }
  }
  for (const RigidState& rigid : state.rigids) {
    if (Fault fault = fault_of(rigid, reach)) {
      return BlowUp{step, time, rigid.name, 0, std::move(*fault)};
    }
  }
  return std::nullopt;
}

}  // namespace weft::scenes
