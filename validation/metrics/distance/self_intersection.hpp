#pragma once

#include <vector>

#include <weft/core/types.hpp>

namespace weft::validation {

/// An edge of a surface that passes through one of its triangles.
struct Piercing {
  int from = 0;  ///< nodes of the edge, from < to
  int to = 0;
  int triangle = 0;
};

/// All pairs of an edge and a triangle that cut each other and share no node, sorted by edge and
/// triangle. Edges that only touch a triangle, and triangles without area, do not count.
/// Shapes   positions 3 x n [m], finite, else nothing is found; triangles 3 x t
[[nodiscard]] std::vector<Piercing> self_piercings(ConstMatrix3XRef<double> positions,
                                                   const Triangles& triangles);

/// Edges of one surface that pass through triangles of another one, and the other way round.
[[nodiscard]] int count_piercings(ConstMatrix3XRef<double> positions, const Triangles& triangles,
                                  ConstMatrix3XRef<double> other_positions,
                                  const Triangles& other_triangles);

}  // namespace weft::validation
