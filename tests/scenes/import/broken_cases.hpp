#pragma once

#include <array>
#include <string_view>

namespace weft::import {

/// A file under tests/scenes/import/broken and a part of the error it must give.
struct BrokenCase {
  std::string_view file;
  std::string_view fragment;
};

// clang-format off
inline constexpr std::array<BrokenCase, 33> kBrokenCases = {{
    {"not_there.obj", "no such file"},
    {"empty.obj", "is empty"},
    {"no_faces.obj", "has no triangle"},
    {"truncated.glb", "cannot be read"},
    {"half.glb", "cannot be read"},
    {"wrong_magic.glb", "cannot be read"},
    {"bad_index.gltf", "out-of-range"},
    {"bad_index.obj", "vertex index out of range"},
    {"nan.ply", "the position of vertex 0 of 'nan' is not finite"},
    {"infinite.stl", "is not finite"},
    {"branching_edge.obj", "more than two triangles meet at the edge at (0.5, 0, 0) m: face 0 of 'fins', face 1 of 'fins', face 2 of 'fins'"},
    {"bow_tie.obj", "two surfaces meet in the single point (0, 0, 0) m: face 0 of 'bow', face 1 of 'bow'"},
    {"flat_face.obj", "face 1 of 'flat' has no area"},
    {"collapsed_face.obj", "face 1 of 'thin' has two corners at one place"},
    {"repeated_corner.ply", "has two corners at one place"},
    {"points_only.ply", "has no triangle"},
    {"lines_only.obj", "has no triangle"},
    {"huge_accessor.gltf", "cannot be read"},
    {"huge_count.ply", "cannot be read"},
    {"flipped.obj", "neighbors turn opposite ways at the edge at"},
    {"missing_buffer.gltf", "the file 'not_there.bin' that it names does not exist"},
    {"circle.gltf", "recursive reference"},
    {"no_such_mesh.gltf", "Array index 7 is out of bounds"},
    {"text.fbx", "cannot be read"},
    {"binary.obj", "has no triangle"},
    {"unknown.xyz", "expected a name that ends with .obj"},
    {"header_without_format.ply", "its header has no line 'end_header'"},
    {"header_with_strange_bytes.ply", "line 2 of its header is 'format ascii 1?0'"},
    {"header_without_end.ply", "its header has no line 'end_header'"},
    {"header_cut_off.ply", "its header has no line 'end_header'"},
    {"buffer_above.gltf", "is no buffer, expected a file that ends with .bin"},
    {"buffer_elsewhere.gltf", "is no buffer, expected a file that ends with .bin"},
    {"buffer_of_no_buffer.gltf", "is no buffer, expected a file that ends with .bin"},
}};
// clang-format on

}  // namespace weft::import
