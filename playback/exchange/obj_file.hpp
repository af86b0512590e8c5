#pragma once

// Tested by tests/playback/exchange/point_cache_export_test.cpp.

#include <string>

#include <weft/mesh/cloth_mesh.hpp>

namespace weft::scenes {

/// Wavefront OBJ text of one object: its rest positions with every digit, texture coordinates, triangles, and lines if it
/// has no triangle. The points keep their order.
[[nodiscard]] std::string obj_text(const std::string& name, const ClothMesh& mesh);

}  // namespace weft::scenes
