#pragma once

// Tested by tests/playback/rendering/renderer_test.cpp.

#include <weft/playback/rendering/meshes/surface_mesh.hpp>
#include <weft/scenes/scene.hpp>

namespace weft::scenes {

/// Surface of a collider in its own frame; empty for a plane, which is the ground.
[[nodiscard]] SurfaceMesh collider_surface(const Shape& shape);

}  // namespace weft::scenes
