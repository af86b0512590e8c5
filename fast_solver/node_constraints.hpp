#pragma once

#include <vector>

#include <weft/core/types.hpp>

namespace weft::fast {

/// A rigid body that is coupled both ways to the nodes that touch it or hang on it.
template <class Scalar>
struct RigidInertia {
  Vector3<Scalar> mass = Vector3<Scalar>::Zero();     ///< in each direction of the world [kg], > 0
  Matrix3<Scalar> inertia = Matrix3<Scalar>::Zero();  ///< about its center, in the world [kg m^2]
  /// What holds it adds so much, for motions of its center and about it [kg, kg m, kg m^2].
  Eigen::Matrix<Scalar, 6, 6> held = Eigen::Matrix<Scalar, 6, 6>::Zero();
  /// How it moves during the step if left alone: of its center [m], about it [rad].
  Vector3<Scalar> motion = Vector3<Scalar>::Zero();
  Vector3<Scalar> turn = Vector3<Scalar>::Zero();
  /// How far it is expected to move by the two-way coupling [m, rad]: of an earlier solution that positions start from.
  Eigen::Matrix<Scalar, 6, 1> guess = Eigen::Matrix<Scalar, 6, 1>::Zero();
};

/// A node must stay in front of a plane at the end of a step, with Coulomb friction on it.
template <class Scalar>
struct PlaneContact {
  int node = 0;
  Vector3<Scalar> normal = Vector3<Scalar>::Zero();  ///< unit vector out of the collider
  Scalar offset = 0;  ///< [m] normal . x >= offset at the end of the step
  Vector3<Scalar> motion = Vector3<Scalar>::Zero();  ///< of the surface there during the step [m]
  Scalar friction = 0;                               ///< Coulomb coefficient [-], >= 0
  /// The collider among the step's rigid bodies, or -1: nothing moves it. Offset and motion are those of a body left alone.
  int body = -1;
  Vector3<Scalar> lever_arm = Vector3<Scalar>::Zero();  ///< from the body's center to the node [m]
};

/// A node that is led: its place at the end of a step.
template <class Scalar>
struct KinematicNode {
  int node = 0;
  Vector3<Scalar> position = Vector3<Scalar>::Zero();  ///< [m]
  int body =
      -1;  ///< that leads it, among the step's rigid bodies, or -1: nothing moves what leads it
  Vector3<Scalar> lever_arm = Vector3<Scalar>::Zero();  ///< from the body's center to the place [m]
};

/// What constraints do to one node during a solve.
enum class ContactState : unsigned char {
  kFree,
  kOnPlane,  ///< in contact, and slides or rests without friction
  kFixed,    ///< sticks, or is led
};

}  // namespace weft::fast
