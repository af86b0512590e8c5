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

/// How far a node of a result that others have computed may be from start_state() in its first frame [m]: 1e-5 of the largest cloth's
/// size. Text with six digits and single precision stay below that; a frame too late, another unit or axis do not.
[[nodiscard]] double start_tolerance(const Scene& scene);

}  // namespace weft::scenes
