#pragma once

// Tested by tests/scenes/import/import_test.cpp.

#include <vector>

#include <weft/core/types.hpp>

namespace weft::import {

/// Gives vertices at the same place one node: for each vertex the number of its node. Nodes are
/// numbered in the order of their first vertices, whose positions they have; a vertex joins the first
/// node within the tolerance [m], >= 0. positions: 3 x n, finite.
[[nodiscard]] std::vector<int> weld(ConstMatrix3XRef<double> positions, double tolerance);

}  // namespace weft::import
