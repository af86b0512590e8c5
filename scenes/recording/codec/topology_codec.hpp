#pragma once

// Tested by tests/scenes/catalog/tear_test.cpp.

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <weft/scenes/cloth_tear.hpp>

namespace weft::scenes {

/// The triangles of a torn cloth, then the origin of each added node, as 32-bit little-endian
/// integers.
[[nodiscard]] std::vector<std::byte> encode_topology(const ClothTopology& topology);

/// The inverse, for a cloth that the scene gives first_nodes nodes and that has num_nodes now.
/// Throws Error for bytes that are not the topology of such a cloth.
[[nodiscard]] ClothTopology decode_topology(std::span<const std::byte> bytes, int first_nodes,
                                            int num_nodes);

}  // namespace weft::scenes
