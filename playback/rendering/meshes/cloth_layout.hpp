#pragma once

// Tested by tests/playback/rendering/renderer_test.cpp, tests/playback/rendering/appearance_render_test.cpp.

#include <cstdint>
#include <vector>

#include <weft/mesh/cloth_mesh.hpp>
#include <weft/playback/rendering/meshes/surface_mesh.hpp>

namespace weft::scenes {

/// What of a drawn cloth does not change: its vertices, more than nodes where a texture has a seam.
struct ClothLayout {
  Triangles triangles;                       ///< node indices
  std::vector<int> nodes;                    ///< the node of each vertex
  std::vector<std::uint32_t> corners;        ///< vertex of each corner of each triangle, 3 t
  std::vector<Eigen::Vector2f> coordinates;  ///< of each vertex in a texture
  std::vector<Eigen::Vector3f> rest_places;  ///< of each vertex, from the centre of the rest shape
  bool has_coordinates = false;              ///< else they are all zero
  bool is_closed = false;                    ///< every edge has two triangles
  Edges rope;                                ///< edges of a body without triangles; else empty
};

[[nodiscard]] ClothLayout make_layout(const ClothMesh& mesh);

/// The cloth as it is now. rope_radius [m] is that of the tubes of a rope.
[[nodiscard]] SurfaceMesh cloth_surface(const ClothLayout& layout,
                                        ConstMatrix3XRef<double> positions, double rope_radius,
                                        const DrawLimits& limits);

}  // namespace weft::scenes
