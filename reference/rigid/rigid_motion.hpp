#pragma once

// Tested by tests/reference/rigid/free_rotation_test.cpp, tests/reference/moving_collider_test.cpp.

#include <weft/reference/options.hpp>
#include <weft/reference/system.hpp>

namespace weft::reference {

/// The motion of one collider over one step. Angular momentum is what is stored between the parts
/// of a step, so that it is conserved to round-off whatever the shape.
struct RigidMotion {
  double inverse_mass = 0.0;  ///< [1/kg], 0: cloth does not move it
  Matrix3<double> start_inverse_inertia = Matrix3<double>::Zero();  ///< world frame [1/(kg m^2)]
  Vector3<double> mean_velocity{0, 0, 0};                           ///< (X1 - X0) / h [m/s]
  Vector3<double> end_velocity{0, 0, 0};                            ///< [m/s]
  /// Orientation at the end of the step without contact, and the angular velocity [rad/s] in its
  /// middle. Contact changes mean_angular_velocity [rad/s]: q1 = exp(h (Omega - free)) q_free.
  Eigen::Quaterniond free_orientation = Eigen::Quaterniond::Identity();
  Vector3<double> free_angular_velocity{0, 0, 0};
  Vector3<double> mean_angular_velocity{0, 0, 0};
  Vector3<double> angular_momentum{0, 0, 0};  ///< about the centre of mass [kg m^2/s]
  double tumbling = 0.0;                      ///< FreeRotation::tumbling() in the step [rad]
};

struct Pose {
  Vector3<double> position;  ///< [m]
  Eigen::Quaterniond orientation;
};

/// About its centre of mass, of a collider with a mass [kg m^2/s], world frame.
[[nodiscard]] Vector3<double> angular_momentum(const Collider& collider);

/// Motion under gravity alone. The translation is what the cloth's method makes of it; the rotation
/// is FreeRotation's for every method, so that angular momentum and energy are kept.
[[nodiscard]] RigidMotion free_motion(const Collider& collider, const Vector3<double>& gravity,
                                      IntegratorKind integrator, double time_step);

/// Pose at the end of the step.
[[nodiscard]] Pose end_pose(const Collider& collider, const RigidMotion& motion, double time_step);

/// Writes the pose and the linear velocity at the end of the step, and the angular velocity that
/// belongs to the angular momentum there.
void write_motion(const RigidMotion& motion, double time_step, Collider& collider);

}  // namespace weft::reference
