#pragma once

// Tested by tests/scenes/characters_test.cpp.

#include <weft/scenes/scene.hpp>

namespace weft::scenes {

/// What an engine starts a cloth with.
struct StartState {
  Matrix3X<double> positions;   ///< 3 x n [m]
  Matrix3X<double> velocities;  ///< 3 x n [m/s], of free nodes
};

/// The rest positions and the cloth's velocity; a part of a character starts where its bones have it
/// and moves with them.
[[nodiscard]] StartState start_state(const Cloth& cloth, const ClothMesh& mesh);

}  // namespace weft::scenes
