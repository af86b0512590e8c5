#pragma once

// Tested by tests/bridge/contact/rigid_response_test.cpp.

#include <LinearMath/btVector3.h>

#include <weft/bridge/bullet/precision.hpp>
#include <weft/core/types.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

/// Bullet's vector as Eigen's, in double precision unless asked otherwise.
template <class Scalar = double>
[[nodiscard]] Vector3<Scalar> from_bullet(const btVector3& v) {
  return {static_cast<Scalar>(v.x()), static_cast<Scalar>(v.y()), static_cast<Scalar>(v.z())};
}

/// A vector (3, or an expression of that size) as Bullet's, rounded to its precision.
template <class Derived>
[[nodiscard]] btVector3 to_bullet(const Eigen::MatrixBase<Derived>& v) {
  return {static_cast<btScalar>(v.coeff(0)), static_cast<btScalar>(v.coeff(1)),
          static_cast<btScalar>(v.coeff(2))};
}

/// A vector of length 1 along another; 0 along 0.
[[nodiscard]] inline btVector3 unit(const btVector3& v) {
  const btScalar length = v.length();
  return length > 0 ? v / length : btVector3(0, 0, 0);
}

/// All that Bullet stores of a vector, at no special address: what a processor loads at once. The last number is of no
/// meaning.
using Four = Eigen::Array<btScalar, 4, 1>;

[[nodiscard]] inline Eigen::Map<Four> four(btVector3& v) {
  return Eigen::Map<Four>(v.m_floats);
}
[[nodiscard]] inline Eigen::Map<const Four> four(const btVector3& v) {
  return Eigen::Map<const Four>(v.m_floats);
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
