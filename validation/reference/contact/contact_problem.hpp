#pragma once

#include <vector>

#include <weft/custom_forces/core/types.hpp>

namespace weft::reference {

/// Unilateral contacts with Coulomb friction between points and rigid bodies, at one instant.
/// Unknowns are impulses; the velocities below change with them.

struct ContactPoint {
  int body = 0;                       ///< index in System::bodies
  int node = 0;                       ///< index in the body
  double inverse_mass = 0.0;          ///< [1/kg]
  Vector3<double> velocity{0, 0, 0};  ///< [m/s]
  Vector3<double> impulse{0, 0, 0};   ///< sum over its contacts [N s]
};

struct ContactRigid {
  double inverse_mass = 0.0;                                  ///< [1/kg], 0: not moved
  Matrix3<double> inverse_inertia = Matrix3<double>::Zero();  ///< world frame [1/(kg m^2)]
  Vector3<double> velocity{0, 0, 0};                          ///< of the centre of mass [m/s]
  Vector3<double> angular_velocity{0, 0, 0};                  ///< [rad/s]
  Vector3<double> impulse{0, 0, 0};                           ///< sum over its contacts [N s]
  Vector3<double> angular_impulse{0, 0, 0};                   ///< about the centre [N m s]
};

/// u = relative velocity of the point. Wanted: normal . u >= target_speed, normal impulse >= 0, one
/// of both an equality; the tangential impulse stops the slip if it can, else it is friction x
/// normal impulse against it.
struct Contact {
  int point = 0;                     ///< index in ContactProblem::points
  int rigid = 0;                     ///< index in ContactProblem::rigids
  Vector3<double> normal{0, 1, 0};   ///< outward from the rigid body
  Vector3<double> lever{0, 0, 0};    ///< from the centre of the rigid body to the point [m]
  double target_speed = 0.0;         ///< [m/s]
  double friction = 0.0;             ///< combined coefficient [-]
  Vector3<double> impulse{0, 0, 0};  ///< on the point [N s]; the rigid body receives the opposite
};

struct ContactProblem {
  std::vector<ContactPoint> points;
  std::vector<ContactRigid> rigids;
  std::vector<Contact> contacts;
};

/// Velocity of the point relative to the surface that it touches [m/s].
[[nodiscard]] Vector3<double> relative_velocity(const ContactProblem& problem,
                                                const Contact& contact);

struct SweepReport {
  int sweeps = 0;         ///< passes over all contacts
  bool converged = true;  ///< the last one changed no velocity by more than kSweepTolerance
};

/// Change of a relative velocity in one visit at which sweeps stop, relative to the largest
/// velocity that takes part [-]: some hundred roundings. Momentum is exact after any number of
/// sweeps.
inline constexpr double kSweepTolerance = 1e-13;
/// A light ball squeezed by many heavy nodes needs about a thousand sweeps; beyond this the outcome
/// says "not converged".
inline constexpr int kMaxSweeps = 10000;

/// Gauss-Seidel over the contacts in their order, with accumulated impulses. No regularisation: a
/// contact that can stick has exactly no slip, one that slips has exactly friction x normal
/// impulse. Starts from the impulses in the contacts, which the velocities must already contain.
[[nodiscard]] SweepReport solve_contacts(ContactProblem& problem);

}  // namespace weft::reference
