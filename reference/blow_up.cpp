#include <weft/reference/blow_up.hpp>

#include <sstream>

#include <weft/reference/rigid/free_rotation.hpp>

namespace weft::reference {
namespace {

std::optional<std::string> over(const char* what, double value, double limit, const char* unit) {
  if (value <= limit) return std::nullopt;
  std::ostringstream reason;
  reason.precision(3);
  reason << what << ' ' << value << ' ' << unit << " is over " << limit << ' ' << unit;
  return reason.str();
}

std::optional<std::string> fault_of_velocity(const Vector3<double>& velocity) {
  if (!velocity.allFinite()) return "velocity is not finite";
  return over("speed", velocity.norm(), kBlowUpSpeed, "m/s");
}

std::optional<std::string> fault_of(const Vector3<double>& position,
                                    const Vector3<double>& velocity) {
  if (!position.allFinite()) return "position is not finite";
  return fault_of_velocity(velocity);
}

std::optional<std::string> fault_of_rotation(const Eigen::Quaterniond& orientation,
                                             const Vector3<double>& angular_velocity) {
  if (!orientation.coeffs().allFinite()) return "orientation is not finite";
  if (!angular_velocity.allFinite()) return "angular velocity is not finite";
  return over("angular speed", angular_velocity.norm(), kBlowUpAngularSpeed, "rad/s");
}

std::optional<std::string> fault_of(const Collider& collider) {
  if (auto fault = fault_of(collider.position, collider.velocity)) return fault;
  return fault_of_rotation(collider.orientation, collider.angular_velocity);
}

std::optional<std::string> fault_of(const RigidMotion& motion) {
  if (auto fault = fault_of_velocity(motion.mean_velocity)) return fault;
  if (auto fault = fault_of_velocity(motion.end_velocity)) return fault;
  if (auto fault = fault_of_rotation(motion.free_orientation, motion.mean_angular_velocity)) {
    return fault;
  }
  return over("tumbling in a step by", motion.tumbling, kMaxTumbling, "rad");
}

}  // namespace

std::optional<BlowUp> find_blow_up(const System& system) {
  for (const Body& body : system.bodies) {
    for (int node = 0; node < body.mesh.num_nodes(); ++node) {
      auto fault = fault_of(body.positions.col(node), body.velocities.col(node));
      if (fault) return BlowUp{body.name, node, std::move(*fault)};
    }
  }
  for (const Collider& collider : system.colliders) {
    if (auto fault = fault_of(collider)) return BlowUp{collider.name, 0, std::move(*fault)};
  }
  return std::nullopt;
}

std::optional<BlowUp> find_blow_up(const System& system, const SystemStep& step) {
  for (std::size_t b = 0; b < system.bodies.size(); ++b) {
    const BodyStep& body = step.bodies[b];
    for (Eigen::Index i = 0; i < body.mean_velocities.cols(); ++i) {
      auto fault = fault_of_velocity(body.mean_velocities.col(i));
      if (!fault) fault = fault_of_velocity(body.end_velocities.col(i));
      if (fault) return BlowUp{system.bodies[b].name, static_cast<int>(i), std::move(*fault)};
    }
  }
  for (std::size_t k = 0; k < system.colliders.size(); ++k) {
    auto fault = fault_of(step.rigids[k]);
    if (fault) return BlowUp{system.colliders[k].name, 0, std::move(*fault)};
  }
  return std::nullopt;
}

}  // namespace weft::reference
