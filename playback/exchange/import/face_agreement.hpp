#pragma once

#include <optional>
#include <string>
#include <vector>

#include <weft/mesh/cloth_mesh.hpp>

namespace weft::scenes {

/// Says why the faces of a file are not the mesh's triangles, node for node; nothing if they are. Faces with more than three
/// corners may be divided along either diagonal, and may turn either way round: each triangle of the mesh must lie in one face, and
/// the faces must hold no other triangle. Points of other places that are numbered otherwise do not pass.
/// Shapes   faces: numbers of nodes from 0, each below mesh.num_nodes()
[[nodiscard]] std::optional<std::string> face_disagreement(
    const ClothMesh& mesh, const std::vector<std::vector<int>>& faces);

}  // namespace weft::scenes
