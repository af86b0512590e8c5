#pragma once

// Tested by tests/characters/skinning_test.cpp.

#include <weft/characters/character.hpp>

namespace weft::characters {

/// The part with vertices merged, the first one's weights and colour kept: files split a surface
/// wherever its normals or texture have a seam, and cloth would come apart there. Triangles that lose
/// a corner are dropped, vertices that no triangle has too.
[[nodiscard]] Part welded(const Part& part, Weld weld, ImportReport& report);

}  // namespace weft::characters
