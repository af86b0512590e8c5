#pragma once

#include <Eigen/Geometry>

#include <weft/core/types.hpp>

namespace weft::reference {

/// How a rigid body turns without a torque: principal moments of inertia [kg m^2], > 0, in the axes
/// of the body, and its angular momentum about the centre of mass [kg m^2/s], world frame, which
/// does not change.
///
/// With the moments I1 <= I2 <= I3 the kinetic energy is
///   L^2 / (2 I2) + l1^2 / 2 (1/I1 - 1/I2) - l3^2 / 2 (1/I2 - 1/I3),  l = L in the body's axes,
/// and each of the three parts alone turns the body about a fixed axis: L, axis 1 and axis 3. The
/// first one commutes with the others, so a sphere, a cylinder, every body with two equal moments is
/// turned exactly, by whatever angle. Any other body is turned by a symmetric composition of order 6
/// (Yoshida 1990, solution A) of the last two, in substeps of at most kTumblingSubstep: a Poisson
/// map, so that the energy errs by a bounded 1e-11 of itself and does not drift. The angular
/// momentum is exact in both cases.
class FreeRotation {
 public:
  FreeRotation(const Vector3<double>& principal_inertia, const Vector3<double>& angular_momentum)
      : inverse_inertia_(principal_inertia.cwiseInverse()), angular_momentum_(angular_momentum) {}

  /// Orientation after a time [s]. Takes no more substeps than kMaxTumbling asks for; beyond that
  /// the result is a rotation still, but not the body's.
  [[nodiscard]] Eigen::Quaterniond advance(const Eigen::Quaterniond& orientation,
                                           double time) const;

  /// Angle [rad] that the tumbling of a body without two equal moments covers in a time [s], from
  /// above: 0 for every other body.
  [[nodiscard]] double tumbling(const Eigen::Quaterniond& orientation, double time) const;

  /// At an orientation [rad/s], world frame.
  [[nodiscard]] Vector3<double> angular_velocity(const Eigen::Quaterniond& orientation) const;

  /// At an orientation [1/(kg m^2)], world frame.
  [[nodiscard]] Matrix3<double> inverse_inertia(const Eigen::Quaterniond& orientation) const;

 private:
  Vector3<double> inverse_inertia_;   // [1/(kg m^2)], per axis of the body
  Vector3<double> angular_momentum_;  // [kg m^2/s]
};

/// Angle of one substep [rad].
inline constexpr double kTumblingSubstep = 0.05;
/// Angle of tumbling that is followed in one step [rad]: 20,000 substeps, about 30 ms.
inline constexpr double kMaxTumbling = 1000.0;

}  // namespace weft::reference
