#pragma once

// Tested by tests/playback/rendering/meshes/shape_mesh_test.cpp.

#include <weft/playback/rendering/meshes/surface_mesh.hpp>

namespace weft::scenes {

/// Ropes: tubes of the given radius [m] around edges. Edges in a row are one smooth tube; where
/// three and more meet, each has a tube of its own. Edges with a node that is not finite or out of
/// the limits are left out. SurfaceMesh::nodes says to which node a vertex belongs.
[[nodiscard]] SurfaceMesh tube_surface(const Edges& edges, ConstMatrix3XRef<double> positions,
                                       double radius, const DrawLimits& limits);

}  // namespace weft::scenes
