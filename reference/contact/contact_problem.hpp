#pragma once

// Tested by tests/reference/contact_test.cpp.

#include <array>
#include <cstdint>
#include <vector>

#include <weft/core/types.hpp>

namespace weft::reference {

/// Unilateral contacts with Coulomb friction between weighted points and rigid bodies, or among
/// weighted points alone, at one instant.
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

/// Points that share a contact: a node, a place on a triangle, or two places that meet.
struct WeightedPoints {
  std::array<int, 4> points{-1, -1, -1, -1};  ///< indices in ContactProblem::points; -1: none
  std::array<double, 4> weights{1, 0, 0, 0};  ///< [-], of the velocities in the contact's one
};

inline constexpr int kNoRigid = -1;

/// u = weighted velocity of the points, relative to the rigid body if there is one. Wanted: normal . u >= target_speed, normal impulse >= 0, one
/// of both an equality; the tangential impulse stops the slip if it can, else it is friction x
/// normal impulse against it.
struct Contact {
  WeightedPoints on = {};
  int rigid = kNoRigid;             ///< index in ContactProblem::rigids
  Vector3<double> normal{0, 1, 0};  ///< outward from the rigid body
  Vector3<double> lever{0, 0, 0};   ///< from the centre of the rigid body to the contact [m]
  double target_speed = 0.0;        ///< [m/s]
  double friction = 0.0;            ///< combined coefficient [-]
  Vector3<double> impulse{0, 0,
                          0};  ///< [N s]; a point gets its weight of it, the rigid body minus it
};

struct ContactProblem {
  std::vector<ContactPoint> points;
  std::vector<ContactRigid> rigids;
  std::vector<Contact> contacts;
};

/// u [m/s].
[[nodiscard]] Vector3<double> relative_velocity(const ContactProblem& problem,
                                                const Contact& contact);

struct SweepReport {
  int sweeps = 0;           ///< passes over all contacts
  std::int64_t visits = 0;  ///< of a contact by a sweep
  bool converged = true;    ///< the last one changed no velocity by more than kSweepTolerance
};

/// Change of a relative velocity in one visit at which sweeps stop, relative to the largest
/// velocity that takes part [-]: some hundred roundings. Momentum is exact after any number of
/// sweeps.
inline constexpr double kSweepTolerance = 1e-13;
/// A light ball squeezed by many heavy nodes needs about a thousand sweeps; beyond this the outcome
/// says "not converged".
inline constexpr int kMaxSweeps = 10000;

/// When sweeps stop.
struct SweepLimits {
  double tolerance = kSweepTolerance;  ///< [-], as kSweepTolerance
  int max_sweeps = kMaxSweeps;
};
/// Where contacts share nodes with many others.
inline constexpr SweepLimits kSharedLimits{.tolerance = 1e-8, .max_sweeps = 300};

/// Gauss-Seidel over the contacts in their order, with accumulated impulses. No regularisation: a
/// contact that can stick has exactly no slip, one that slips has exactly friction x normal
/// impulse. Starts from the impulses in the contacts, which the velocities must already contain.
[[nodiscard]] SweepReport solve_contacts(ContactProblem& problem, const SweepLimits& limits = {});

}  // namespace weft::reference
