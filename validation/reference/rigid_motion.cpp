#include <weft/validation/reference/rigid_motion.hpp>

namespace weft::reference {
namespace {

/// exp(rotation_vector) q, rotation_vector in the world frame [rad].
Eigen::Quaterniond rotated(const Eigen::Quaterniond& orientation,
                           const Vector3<double>& rotation_vector) {
  const double angle = rotation_vector.norm();
  if (!(angle > 0.0)) return orientation;
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(angle, rotation_vector / angle));
  return (turn * orientation).normalized();
}

Matrix3<double> inverse_inertia(const Collider& collider, const Eigen::Quaterniond& orientation) {
  const Matrix3<double> rotation = orientation.toRotationMatrix();
  const Vector3<double> inverse = principal_inertia(collider).cwiseInverse();
  return rotation * inverse.asDiagonal() * rotation.transpose();
}

}  // namespace

RigidMotion free_motion(const Collider& collider, const Vector3<double>& gravity,
                        IntegratorKind integrator, double time_step) {
  RigidMotion motion;
  motion.mean_velocity = motion.end_velocity = collider.velocity;
  motion.mean_angular_velocity = collider.angular_velocity;
  if (!collider.mass) return motion;

  motion.inverse_mass = 1.0 / *collider.mass;
  motion.start_inverse_inertia = inverse_inertia(collider, collider.orientation);
  motion.angular_momentum = world_inertia(collider) * collider.angular_velocity;
  motion.end_velocity += time_step * gravity;
  switch (integrator) {
    case IntegratorKind::kExplicitEuler:
      break;
    case IntegratorKind::kModifiedEuler:
    case IntegratorKind::kImplicitEuler:
      motion.mean_velocity = motion.end_velocity;
      break;
    default: {
      motion.mean_velocity += 0.5 * time_step * gravity;
      const Eigen::Quaterniond middle =
          rotated(collider.orientation, 0.5 * time_step * collider.angular_velocity);
      motion.mean_angular_velocity = inverse_inertia(collider, middle) * motion.angular_momentum;
      break;
    }
  }
  return motion;
}

Pose end_pose(const Collider& collider, const RigidMotion& motion, double time_step) {
  return {collider.position + time_step * motion.mean_velocity,
          rotated(collider.orientation, time_step * motion.mean_angular_velocity)};
}

void write_motion(const RigidMotion& motion, double time_step, Collider& collider) {
  const Pose pose = end_pose(collider, motion, time_step);
  collider.position = pose.position;
  collider.orientation = pose.orientation;
  collider.velocity = motion.end_velocity;
  if (collider.mass) {
    collider.angular_velocity =
        inverse_inertia(collider, collider.orientation) * motion.angular_momentum;
  }
}

}  // namespace weft::reference
