#pragma once

// Tested by tests/characters/gltf_faults_test.cpp, tests/characters/skinning_test.cpp.

#include <vector>

#include <weft/characters/character.hpp>
#include <weft/characters/gltf_document.hpp>

namespace weft::characters {

/// The parts of the glTF reader, private to it. bone_of_node: for each node of the file its bone, -1
/// for a node outside the scene.

/// Bones of the file's scene, parents first, children in the order of the file.
struct ReadBones {
  Skeleton skeleton;
  std::vector<int> bone_of_node;
  std::vector<std::size_t> node_of_bone;
};
[[nodiscard]] ReadBones read_bones(const GltfDocument& document);

[[nodiscard]] std::vector<Clip> read_clips(const GltfDocument& document,
                                           const std::vector<int>& bone_of_node);

[[nodiscard]] std::vector<Part> read_parts(const GltfDocument& document, const ReadBones& bones,
                                           ImportReport& report);

/// An affine 4 x 4 matrix from 16 numbers, column by column. Fails if its last row is not 0 0 0 1.
[[nodiscard]] Eigen::Affine3d affine_of(const GltfDocument& document,
                                        const Eigen::VectorXd& numbers, const std::string& where);

}  // namespace weft::characters
