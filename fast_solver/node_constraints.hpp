#pragma once

// Tested by tests/fast_solver/implicit_solver_test.cpp.

#include <algorithm>
#include <vector>

#include <weft/core/types.hpp>

namespace weft::fast {

/// A rigid body that is coupled both ways to the nodes that touch it or are attached to it.
template <class Scalar>
struct RigidInertia {
  Vector3<Scalar> mass = Vector3<Scalar>::Zero();     ///< in each direction of the world [kg], > 0
  Matrix3<Scalar> inertia = Matrix3<Scalar>::Zero();  ///< about its center, in the world [kg m^2]
  /// The generalized inertia that joints give a link of a multibody, in place of mass and inertia, which are zero then
  /// [kg, kg m, kg m^2].
  Eigen::Matrix<Scalar, 6, 6> of_link = Eigen::Matrix<Scalar, 6, 6>::Zero();
  bool has_base = false;  ///< of a link: its multibody stands on a base that cloth cannot move
  /// Generalized inertia that the body's supports add [kg, kg m, kg m^2].
  Eigen::Matrix<Scalar, 6, 6> held = Eigen::Matrix<Scalar, 6, 6>::Zero();
  /// Its motion during the step without the cloth: translation of its center [m], rotation [rad].
  Vector3<Scalar> motion = Vector3<Scalar>::Zero();
  Vector3<Scalar> turn = Vector3<Scalar>::Zero();
  /// Initial guess of the generalized displacement [m, rad]; it belongs to the solution that the iteration starts from.
  Eigen::Matrix<Scalar, 6, 1> guess = Eigen::Matrix<Scalar, 6, 1>::Zero();
};

/// The inertia between two links of one multibody: the force on the first is this times the acceleration of the second.
template <class Scalar>
struct InertiaCoupling {
  int first = 0;
  int second = 0;
  Eigen::Matrix<Scalar, 6, 6> inertia = Eigen::Matrix<Scalar, 6, 6>::Zero();
};

/// A node must stay in front of a plane at the end of a step, with Coulomb friction on it.
template <class Scalar>
struct PlaneContact {
  int node = 0;
  Vector3<Scalar> normal = Vector3<Scalar>::Zero();  ///< unit vector out of the collider
  Scalar offset = 0;  ///< [m] normal . x >= offset at the end of the step
  Vector3<Scalar> motion = Vector3<Scalar>::Zero();  ///< for the surface there during the step [m]
  Scalar friction = 0;                               ///< Coulomb coefficient [-], >= 0
  /// By which another surface presses the node onto this one [N]. If it is not zero, the node stays on the plane whatever pulls.
  Scalar squeeze = 0;
  Scalar squeeze_friction = 0;  ///< Coulomb coefficient of that surface [-], >= 0
  /// The collider among the step's rigid bodies, or -1: nothing moves it. Offset and motion are those without the cloth.
  int body = -1;
  Vector3<Scalar> lever_arm = Vector3<Scalar>::Zero();  ///< from the body's center to the node [m]

  /// The largest friction on the node [N] if it pushes against the plane by so much [N] beside the squeeze. A node that pulls harder
  /// than it is squeezed bears on the other surface alone.
  [[nodiscard]] Scalar friction_bound(Scalar push) const {
    const Scalar bound = friction * std::max(Scalar(0), push + squeeze);
    return squeeze > 0 ? bound + squeeze_friction * std::max(squeeze, -push) : bound;
  }
  /// The coefficient of all surfaces together [-].
  [[nodiscard]] Scalar all_friction() const { return friction + squeeze_friction; }
};

/// A surface behind a node that a rigid body presses on it: a spring along its normal, which only pushes, with Coulomb friction.
template <class Scalar>
struct NodeSupport {
  int node = 0;
  Vector3<Scalar> normal = Vector3<Scalar>::Zero();  ///< unit vector out of the surface
  Scalar offset = 0;  ///< [m] it pushes where normal . x < offset at the end of the step
  Vector3<Scalar> motion = Vector3<Scalar>::Zero();  ///< for the surface there during the step [m]
  Scalar stiffness = 0;                              ///< [N/m], > 0
  Scalar friction = 0;                               ///< Coulomb coefficient [-], >= 0
  int body = -1;                                     ///< as of a PlaneContact
  Vector3<Scalar> lever_arm = Vector3<Scalar>::Zero();  ///< from the body's center to the node [m]
};

/// A node with a prescribed position at the end of a step.
template <class Scalar>
struct KinematicNode {
  int node = 0;
  Vector3<Scalar> position = Vector3<Scalar>::Zero();  ///< [m]
  int body = -1;  ///< the step's rigid body that prescribes it, or -1 if nothing moves that body
  Vector3<Scalar> lever_arm = Vector3<Scalar>::Zero();  ///< from the body's center to the node [m]
};

/// A node that slides on a plane, as the coarse correction sees it.
struct SlidingNode {
  int node = 0;
  Vector3<float> normal = Vector3<float>::Zero();  ///< unit vector
  float stiffness = 0;  ///< in that direction, for what does not move there [N/m]
  float drag = 0;       ///< of friction [N/m]
};

/// The contact state of one node during a solve.
enum class ContactState : unsigned char {
  kFree,
  kOnPlane,  ///< in contact, and slides or rests without friction
  kFixed,    ///< sticks, or is kinematic
};

}  // namespace weft::fast
