#pragma once

// Tested by tests/contract/input_contract_test.cpp.

#include <string_view>
#include <vector>

#include <weft/custom_forces/law_info.hpp>
#include <weft/mesh/cloth_mesh.hpp>

namespace weft::forces {

/// How a law reads a specification that checked() has passed.

[[nodiscard]] double law_scalar(const LawSpecification& specification, std::string_view parameter);
[[nodiscard]] Vector3<double> law_vector(const LawSpecification& specification,
                                         std::string_view parameter);

/// Edges of the sets the specification names, all sets of the mesh if it names none. Throws
/// InvalidArgument for a set the mesh does not have and for an edge to a node it does not have.
[[nodiscard]] Edges law_edges(const LawSpecification& specification, const ClothMesh& mesh);

/// Rest length of each edge [m]. Throws InvalidArgument that names the nodes of an edge without
/// length.
[[nodiscard]] VectorX<double> law_rest_lengths(const LawSpecification& specification,
                                               const ClothMesh& mesh, const Edges& edges);

/// Nodes of the sets the specification names, all sets of the mesh if it names none; sorted, each
/// once. Throws InvalidArgument for a set and for a node that the mesh does not have.
[[nodiscard]] std::vector<int> law_nodes(const LawSpecification& specification,
                                         const ClothMesh& mesh);

/// The triangles of the mesh. Throws InvalidArgument for one with a node the mesh does not have.
[[nodiscard]] Triangles law_faces(const LawSpecification& specification, const ClothMesh& mesh);

}  // namespace weft::forces
