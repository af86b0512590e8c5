#pragma once

#include <vector>

#include <weft/custom_forces/core/types.hpp>

namespace weft::fast {

/// A node must stay in front of a plane at the end of a step, with Coulomb friction on it.
template <class Scalar>
struct PlaneContact {
  int node = 0;
  Vector3<Scalar> normal = Vector3<Scalar>::Zero();  ///< unit vector out of the obstacle
  Scalar offset = 0;  ///< [m] normal . x >= offset at the end of the step
  Vector3<Scalar> motion = Vector3<Scalar>::Zero();  ///< of the surface there during the step [m]
  Scalar friction = 0;                               ///< Coulomb coefficient [-], >= 0
  /// Of the obstacle, as much as this contact has to move [kg]; 0: nothing moves it. Offset and motion
  /// are then those of the obstacle left alone. It gives way by force h^2 / mass, as Newton says.
  Scalar mass = 0;
};

/// A node that is led: its place at the end of a step.
template <class Scalar>
struct LedNode {
  int node = 0;
  Vector3<Scalar> place = Vector3<Scalar>::Zero();  ///< [m]
  Scalar mass = 0;  ///< of what leads it [kg], as that of a contact; 0: nothing moves it
};

/// What constraints do to one node during a solve.
enum class Hold : unsigned char {
  kFree,
  kOnPlane,  ///< in contact, and slides or rests without friction
  kFixed,    ///< sticks, or is led
  kTied,     ///< a spring ties it to where it would stick to a body that gives way, or to its plane
};

}  // namespace weft::fast
