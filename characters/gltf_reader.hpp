#pragma once

// Tested by tests/characters/gltf_faults_test.cpp, tests/characters/skinning_test.cpp.

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

#include <weft/characters/character.hpp>
#include <weft/core/input_file.hpp>

namespace weft::characters {

/// Reads bones, clips and surfaces of a glTF 2.0 file (.glb, or .gltf with its buffers). Lengths are
/// metres, as glTF says. Read directly and not through assimp 5.2, which tells neither the
/// interpolation of a channel nor the tangents of a spline.
///
/// * What has no name is called node_3, mesh_0, clip_1, after its place in the file.
/// * A node that carries a mesh without a skin is its own joint.
/// * Weights are divided by their sum; the report says where that was not 1.
/// * A skin without inverse bind matrices takes the unit matrix, as glTF says.
/// * Morph targets, cameras, lights and pictures are left out; the report says so of morph targets.
///
/// Throws InvalidArgument that names the file and the place in it for anything that is no such file:
/// damaged containers, indices and bytes out of range, numbers that are not finite, hierarchies with a
/// loop, matrices without an inverse, times that do not grow, weights that sum to 0, compression.
///
/// files: the buffers that the file may name; without them it may name none.
[[nodiscard]] Character read_gltf(std::span<const std::byte> bytes, const std::string& name,
                                  const FileSource& files = {});
/// The same for a file, whose buffers are in its folder or below. Throws InvalidArgument if it cannot
/// be read.
[[nodiscard]] Character read_gltf_file(const std::filesystem::path& path);

}  // namespace weft::characters
