#pragma once

#include <vector>

#include <weft/bridge/bullet/precision.hpp>
#include <weft/mesh/cloth_mesh.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

/// Groups of nodes of which no two feel each other through an edge, line or connection of any set, a
/// triangle, or the two triangles at an edge. One product with a matrix of such a coupling then gives the diagonal
/// blocks of a whole group at once. Greedy, in the order of the nodes; 9 groups for a 24-neighbor
/// grid.
[[nodiscard]] std::vector<std::vector<int>> node_colors(const ClothMesh& mesh);

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
