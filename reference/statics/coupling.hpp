#pragma once

// Tested by tests/reference/statics/static_solver_test.cpp, tests/reference/implicit_integrators_test.cpp.

#include <vector>

#include <weft/core/types.hpp>
#include <weft/reference/system.hpp>

namespace weft::reference {

/// Pairs of different nodes whose forces may depend on each other's positions, 2 x m, first index <
/// second index, sorted: the nodes that share an element of the body's laws.
/// Throws InvalidArgument for a law that couples every node with every other (a closed gas): its
/// matrix is not sparse.
[[nodiscard]] Edges coupled_nodes(const Body& body);

/// Whether a law couples only the nodes of its springs, lines, hinges or faces. Laws of whole bodies
/// and of far connections do not: a matrix that holds them is not sparse.
[[nodiscard]] bool has_short_reach(const forces::LawTraits& traits);

/// The pairs of coupled_nodes() for the laws of short reach alone.
[[nodiscard]] Edges nearly_coupled_nodes(const Body& body);

/// A colour for each of num_nodes nodes such that no two nodes of one colour are coupled with one and
/// the same node, nor with each other: one product with the stiffness then shows the columns of all
/// nodes of a colour at once.
[[nodiscard]] std::vector<int> column_colors(const Edges& coupled, int num_nodes);

}  // namespace weft::reference
