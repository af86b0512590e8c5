#pragma once

// Tested by tests/playback/rendering/golden_test.cpp.

#include <weft/scenes/simulator.hpp>

namespace weft::scenes {

/// The state that every engine starts a scene with, for pictures without an engine.
[[nodiscard]] SceneState start_of_scene(const Scene& scene);

}  // namespace weft::scenes
