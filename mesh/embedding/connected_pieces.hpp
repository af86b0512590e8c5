#pragma once

// Tested by tests/mesh/embedding/cloth_embedding_test.cpp.

#include <vector>

#include <weft/core/types.hpp>

namespace weft {

/// The vertices of each connected piece of a surface, in ascending order, pieces in the order of their first vertices. Vertices at
/// the same place are one: a seam of a texture parts nothing. A vertex without a triangle is a piece.
[[nodiscard]] std::vector<std::vector<int>> connected_pieces(ConstMatrix3XRef<double> positions,
                                                             const Triangles& triangles);

}  // namespace weft
