#pragma once

#include <weft/scenes/scene.hpp>

namespace weft::scenes {

/// The scene with meshes in place of its characters' parts, and colliders that no bone leads: what is drawn is the same,
/// and takes no reader of character files.
[[nodiscard]] Scene drawn_scene(Scene scene);

}  // namespace weft::scenes
