#pragma once

// Tested by tests/playback/rendering/meshes/cloth_drawing_test.cpp.

#include <vector>

#include <weft/mesh/embedding/drawn_mesh.hpp>
#include <weft/mesh/surface_body.hpp>

namespace weft::scenes {

/// A drawn mesh as renderers want it: one vertex for each place in the texture and on each side of a crease.
struct DrawnLayout {
  DrawnMesh mesh;                            ///< with normals
  std::vector<Eigen::Vector2f> coordinates;  ///< of each vertex in a texture
  std::vector<Eigen::Vector3f> rest_places;  ///< of each vertex, from the centre of the mesh [m]
  bool has_coordinates = false;              ///< else they are all zero
  bool is_closed = false;                    ///< every edge has two triangles
};

/// Triangles that meet at less than 50 degrees are smooth, others have a crease between them.
[[nodiscard]] DrawnLayout make_drawn_layout(const Surface& surface);

}  // namespace weft::scenes
