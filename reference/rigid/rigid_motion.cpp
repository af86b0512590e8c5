#include <weft/reference/rigid/rigid_motion.hpp>

#include <weft/reference/rigid/free_rotation.hpp>

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

}  // namespace

Vector3<double> angular_momentum(const Collider& collider) {
  const Eigen::Quaterniond& orientation = collider.orientation;
  const Vector3<double> angular_velocity = orientation.conjugate() * collider.angular_velocity;
  return orientation * principal_inertia(collider).cwiseProduct(angular_velocity);
}

RigidMotion free_motion(const Collider& collider, const Vector3<double>& gravity,
                        IntegratorKind integrator, double time_step) {
  RigidMotion motion;
  motion.mean_velocity = motion.end_velocity = collider.velocity;
  if (!collider.mass) {
    motion.mean_angular_velocity = motion.free_angular_velocity = collider.angular_velocity;
    motion.free_orientation = rotated(collider.orientation, time_step * collider.angular_velocity);
    return motion;
  }

  motion.inverse_mass = 1.0 / *collider.mass;
  motion.end_velocity += time_step * gravity;
  if (moves_with_end_velocity(integrator)) {
    motion.mean_velocity = motion.end_velocity;
  } else if (integrator != IntegratorKind::kExplicitEuler) {
    motion.mean_velocity += 0.5 * time_step * gravity;
  }

  motion.angular_momentum = angular_momentum(collider);
  const FreeRotation rotation(principal_inertia(collider), motion.angular_momentum);
  motion.tumbling = rotation.tumbling(collider.orientation, time_step);
  const Eigen::Quaterniond middle = rotation.advance(collider.orientation, 0.5 * time_step);
  motion.start_inverse_inertia = rotation.inverse_inertia(collider.orientation);
  motion.free_angular_velocity = rotation.angular_velocity(middle);
  motion.mean_angular_velocity = motion.free_angular_velocity;
  motion.free_orientation = rotation.advance(middle, 0.5 * time_step);
  return motion;
}

Pose end_pose(const Collider& collider, const RigidMotion& motion, double time_step) {
  return {collider.position + time_step * motion.mean_velocity,
          rotated(motion.free_orientation,
                  time_step * (motion.mean_angular_velocity - motion.free_angular_velocity))};
}

void write_motion(const RigidMotion& motion, double time_step, Collider& collider) {
  const Pose pose = end_pose(collider, motion, time_step);
  collider.position = pose.position;
  collider.orientation = pose.orientation;
  collider.velocity = motion.end_velocity;
  if (collider.mass) {
    collider.angular_velocity = FreeRotation(principal_inertia(collider), motion.angular_momentum)
                                    .angular_velocity(collider.orientation);
  }
}

}  // namespace weft::reference
