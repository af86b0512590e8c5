#pragma once

// Tested by tests/custom_forces/body_sources_test.cpp.

#include <weft/mesh/cloth_mesh.hpp>

namespace weft {

/// A straight rope: nodes at equal distances from start to end.
struct Rope {
  int nodes = 2;                             ///< 2 to 10 million
  Vector3<double> start{0, 0, 0};            ///< [m] of node 0
  Vector3<double> end{1, 0, 0};              ///< [m] of the last node
  double total_mass = 1.0;                   ///< [kg], > 0
  MassLumping lumping = MassLumping::kArea;  ///< kArea: by length, the end nodes weigh half
};

/// Builds the mesh: edge sets "stretch" (next neighbors) and "bend" (next but one), line set "lines"
/// (three in a row), no triangles, texture coordinates (i / (nodes - 1), 0). Throws InvalidArgument
/// for values out of their domain and for a rope without length.
[[nodiscard]] ClothMesh make_rope(const Rope& rope);

}  // namespace weft
