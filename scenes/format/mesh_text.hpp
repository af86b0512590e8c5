#pragma once

// Tested by tests/scenes/body_sources_test.cpp.

#include <string>
#include <string_view>

#include <weft/mesh/surface_body.hpp>

namespace weft::scenes {

/// A surface as letters and digits, for the resolved text of a scene: base64 of "WEFTMESH", the
/// numbers of nodes n, triangles t and texture places (0, or 3t), the positions (3n doubles), the
/// triangles (3t 32-bit integers) and the places of their corners (2 doubles each), little-endian.
[[nodiscard]] std::string mesh_text(const Surface& surface);

/// The inverse, bit for bit. Throws InvalidArgument for anything else.
[[nodiscard]] Surface parse_mesh_text(std::string_view text);

}  // namespace weft::scenes
