#pragma once

#include <weft/validation/reference/options.hpp>
#include <weft/validation/reference/system.hpp>

namespace weft::reference {

/// The motion of one collider over one step. Angular momentum is what is stored between the parts
/// of a step, so that it is conserved to round-off whatever the shape.
struct RigidMotion {
  double inverse_mass = 0.0;  ///< [1/kg], 0: cloth does not move it
  Matrix3<double> start_inverse_inertia = Matrix3<double>::Zero();  ///< world frame [1/(kg m^2)]
  Vector3<double> mean_velocity{0, 0, 0};                           ///< (X1 - X0) / h [m/s]
  Vector3<double> end_velocity{0, 0, 0};                            ///< [m/s]
  Vector3<double> mean_angular_velocity{0, 0, 0};  ///< q1 = exp(h Omega) q0 [rad/s]
  Vector3<double> angular_momentum{0, 0, 0};       ///< about the centre of mass [kg m^2/s]
};

struct Pose {
  Vector3<double> position;  ///< [m]
  Eigen::Quaterniond orientation;
};

/// Motion under gravity alone, with the same method as the cloth: the translation of each method is
/// exact for it; the rotation is q1 = exp(h Omega) q0 with Omega at the start (Euler methods, order
/// 1) or at the midpoint (all others, order 2; exact for a sphere).
[[nodiscard]] RigidMotion free_motion(const Collider& collider, const Vector3<double>& gravity,
                                      IntegratorKind integrator, double time_step);

/// Pose at the end of the step.
[[nodiscard]] Pose end_pose(const Collider& collider, const RigidMotion& motion, double time_step);

/// Writes the pose and the linear velocity at the end of the step, and the angular velocity that
/// belongs to the angular momentum there.
void write_motion(const RigidMotion& motion, double time_step, Collider& collider);

}  // namespace weft::reference
