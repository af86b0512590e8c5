#pragma once

#include <vector>

#include <weft/custom_forces/core/types.hpp>

namespace weft::fast {

/// A node must stay in front of a plane at the end of a step, with Coulomb friction on it.
template <class Scalar>
struct PlaneContact {
  int node = 0;
  Vector3<Scalar> normal = Vector3<Scalar>::Zero();  ///< unit vector out of the obstacle
  Scalar offset = 0;    ///< [m] normal . x >= offset at the end of the step
  Vector3<Scalar> motion = Vector3<Scalar>::Zero();  ///< of the surface there during the step [m]
  Scalar friction = 0;  ///< Coulomb coefficient [-], >= 0
};

/// A node that is led: its place at the end of a step.
template <class Scalar>
struct LedNode {
  int node = 0;
  Vector3<Scalar> place = Vector3<Scalar>::Zero();  ///< [m]
};

/// What constraints do to one node during a solve.
enum class Hold : unsigned char {
  kFree,
  kOnPlane,  ///< in contact, and slides or rests without friction
  kFixed,    ///< sticks, or is led
};

}  // namespace weft::fast
