#pragma once

#include <vector>

#include <weft/core/types.hpp>

namespace weft::validation {

/// Part of a mesh's nodes, and triangles between them.
struct DecimatedMesh {
  std::vector<int> nodes;      ///< of the mesh, growing
  std::vector<int> triangles;  ///< 3 each, indices into nodes
};

/// At most max_nodes nodes, evenly over the rest shape: one per cell of a cubic lattice, the nearest to
/// its middle; triangles of three different cells stay (Rossignac and Borrel 1993). All nodes if there
/// are few enough. @throws InvalidArgument unless max_nodes >= 1.
[[nodiscard]] DecimatedMesh decimate(ConstMatrix3XRef<double> rest_positions,
                                     const Triangles& triangles, int max_nodes);

}  // namespace weft::validation
