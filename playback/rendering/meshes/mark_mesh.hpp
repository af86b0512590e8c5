#pragma once

// Tested by tests/playback/rendering/meshes/mark_mesh_test.cpp.

#include <weft/playback/rendering/meshes/surface_mesh.hpp>
#include <weft/scenes/appearance/mark.hpp>

namespace weft::scenes {

/// Balls of this radius [m] for points, rods with two fifths of it for lines, and rods with a tip for arrows. Few triangles each,
/// for there may be thousands. What is not finite or out of the limits is left out.
[[nodiscard]] SurfaceMesh mark_surface(const Mark& mark, double radius, const DrawLimits& limits);

}  // namespace weft::scenes
