#pragma once

#include "tests/contract/measurement.hpp"
#include "tests/contract/subject.hpp"

namespace weft::contract {

/// What a law with the trait `internal` promises, for Scalar float and double. All bounds are
/// round-off: n eps scale.

template <class Scalar>
[[nodiscard]] Measurement net_force_is_zero(const Subject& subject);

template <class Scalar>
[[nodiscard]] Measurement net_torque_is_zero(const Subject& subject);

/// f(R x + t, R v) = R f(x, v).
template <class Scalar>
[[nodiscard]] Measurement force_turns_with_the_body(const Subject& subject);

/// f(x, omega x r + v0) = f(x, 0), at rest shape and deformed.
template <class Scalar>
[[nodiscard]] Measurement rigid_motion_adds_no_force(const Subject& subject);

template <class Scalar>
[[nodiscard]] Measurement rest_shape_is_free_of_force(const Subject& subject);

}  // namespace weft::contract
