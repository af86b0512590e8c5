#pragma once

// Tested by tests/engines/snapshot_test.cpp.

#include <weft/core/state_archive.hpp>
#include <weft/mesh/cloth_mesh.hpp>

namespace weft {

/// Everything of a mesh: for one that has torn, which no scene can make again.
void serialize(StateArchive& archive, ClothMesh& mesh);

}  // namespace weft
