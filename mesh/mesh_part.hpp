#pragma once

// Tested by tests/fast_solver/torn_network_test.cpp.

#include <vector>

#include <weft/mesh/cloth_mesh.hpp>

namespace weft {

/// A part of a mesh as a mesh of its own.
struct MeshPart {
  ClothMesh mesh;
  std::vector<int> nodes;  ///< node of the whole mesh of each of its nodes, ascending
};

/// The elements of a mesh that have a wanted node, with the triangles around their nodes: every hinge
/// that has a wanted node is whole. Sets keep their names, and their elements their order; connections,
/// node sets and textures are left out. One crossed triangle at least, if the mesh has any.
/// is_wanted: flags of the nodes.
[[nodiscard]] MeshPart part_around(const ClothMesh& mesh, const std::vector<char>& is_wanted);

}  // namespace weft
