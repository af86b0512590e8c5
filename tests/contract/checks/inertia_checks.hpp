#pragma once

#include "tests/contract/measurement.hpp"
#include "tests/contract/subject.hpp"

namespace weft::contract {

/// What a law of level kInertia promises about redistribute_forces: R below, an operator on the
/// forces of a body. Two nodes of the mesh are pinned unless the comment says otherwise. Bounds are
/// round-off: n eps scale. Scalar is float or double.

/// add_forces and the products add nothing, and the power is 0.
template <class Scalar>
[[nodiscard]] Measurement inertia_adds_nothing(const Subject& subject);

/// R(2 F - G) = 2 R(F) - R(G).
template <class Scalar>
[[nodiscard]] Measurement inertia_is_linear(const Subject& subject);

/// The sum of the forces on free nodes stays, and each force on a pinned node, bit for bit.
template <class Scalar>
[[nodiscard]] Measurement inertia_keeps_the_net_force(const Subject& subject);

/// Forces along edges have no torque; neither has what R makes of them. No node is pinned.
template <class Scalar>
[[nodiscard]] Measurement inertia_adds_no_torque(const Subject& subject);

/// R(M g) = M g for a uniform acceleration g.
template <class Scalar>
[[nodiscard]] Measurement inertia_keeps_uniform_accelerations(const Subject& subject);

/// a . R(M b) = b . R(M a): the law's inertia has a kinetic energy.
template <class Scalar>
[[nodiscard]] Measurement inertia_is_symmetric(const Subject& subject);

/// -a . R(M a) < 0 for accelerations of every kind: no force is turned round or lost.
template <class Scalar>
[[nodiscard]] Measurement inertia_is_positive(const Subject& subject);

/// The power F . v of the forces before R is what the plain and the added kinetic energy gain
/// under the accelerations after R.
[[nodiscard]] Measurement inertia_balances_its_energy(const Subject& subject);

/// Entries whose bits differ between two calls, and between 1 and 4 threads.
template <class Scalar>
[[nodiscard]] Measurement inertia_repeats_bit_for_bit(const Subject& subject);

/// R in float against double.
[[nodiscard]] Measurement inertia_in_float_agrees_with_double(const Subject& subject);

/// A law of another level changes no bit of the forces and adds no kinetic energy.
template <class Scalar>
[[nodiscard]] Measurement redistribution_changes_nothing(const Subject& subject);

}  // namespace weft::contract
