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
inline constexpr std::array<BrokenCase, 25> kBrokenCases = {{
    {"not_there.obj", "no such file"},
    {"empty.obj", "is empty"},
    {"no_faces.obj", ""},
    {"truncated.glb", "cannot be read"},
    {"half.glb", "cannot be read"},
    {"wrong_magic.glb", "cannot be read"},
    {"bad_index.gltf", ""},
    {"bad_index.obj", ""},
    {"nan.ply", "the position of vertex 0 of"},
    {"infinite.stl", "is not finite"},
    {"branching_edge.obj", "more than two triangles meet at the edge at (0.5, 0, 0) m: face 0 of 'fins', face 1 of 'fins', face 2 of 'fins'"},
    {"bow_tie.obj", "two surfaces meet in the single point (0, 0, 0) m: face 0 of 'bow', face 1 of 'bow'"},
    {"flat_face.obj", "face 1 of 'flat' has no area"},
    {"collapsed_face.obj", "face 1 of 'thin' has two corners at one place"},
    {"repeated_corner.ply", "has two corners at one place"},
    {"points_only.ply", ""},
    {"lines_only.obj", ""},
    {"huge_count.ply", "cannot be read"},
    {"flipped.obj", "neighbours turn opposite ways at the edge at"},
    {"missing_buffer.gltf", "cannot be read"},
    {"circle.gltf", "cannot be read"},
    {"no_such_mesh.gltf", ""},
    {"text.fbx", "cannot be read"},
    {"binary.obj", ""},
    {"unknown.xyz", "cannot be read"},
}};
// clang-format on

}  // namespace weft::import
