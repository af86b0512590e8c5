#pragma once

#include "tests/contract/measurement.hpp"
#include "tests/contract/subject.hpp"

namespace weft::contract {

/// Nothing that a user cannot see may change the result. Scalar is float or double.

/// The edges, lines and triangles in another order: equal within round-off.
template <class Scalar>
[[nodiscard]] Measurement edge_order_does_not_matter(const Subject& subject);

/// The nodes renumbered: the forces are renumbered likewise, within round-off.
template <class Scalar>
[[nodiscard]] Measurement node_order_does_not_matter(const Subject& subject);

/// Entries whose bits differ between two calls on one law.
template <class Scalar>
[[nodiscard]] Measurement calls_repeat_bit_for_bit(const Subject& subject);

/// Entries of forces and products whose bits differ between 1, 2 and 4 threads, on a sheet that
/// makes many chunks.
template <class Scalar>
[[nodiscard]] Measurement threads_change_no_bit(const Subject& subject);

/// For a pointwise law: entries of forces whose bits differ where it is asked for some of the nodes at a time.
template <class Scalar>
[[nodiscard]] Measurement some_nodes_are_enough(const Subject& subject);

/// add_* add: what is in the result before is still in it afterwards, within round-off.
template <class Scalar>
[[nodiscard]] Measurement results_are_added(const Subject& subject);

/// Forces on a mesh without edges, lines, triangles and connections, for a law that acts on some of
/// them [N].
template <class Scalar>
[[nodiscard]] Measurement no_elements_no_force(const Subject& subject);

/// Two nodes and one edge: entries of forces and products that are not finite.
template <class Scalar>
[[nodiscard]] Measurement two_nodes_suffice(const Subject& subject);

}  // namespace weft::contract
