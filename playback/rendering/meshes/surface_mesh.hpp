#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include <weft/core/types.hpp>

namespace weft::scenes {

/// What the shaders read per vertex.
struct SurfaceVertex {
  Eigen::Vector3f position{0, 0, 0};
  Eigen::Vector3f normal{0, 1, 0};
  /// Texture coordinates; or place on the colour scale, 0 to 1, and 1 if there is a value, 0 if not.
  Eigen::Vector2f value{0, 0};
  /// Place on the body [m]; for cloth from its centre at rest; or barycentric (wireframe).
  Eigen::Vector3f extra{0, 0, 0};
};

struct SurfaceMesh {
  std::vector<SurfaceVertex> vertices;
  std::vector<std::uint32_t> indices;  ///< 3 per triangle, counter-clockwise seen from the front
  std::vector<int> nodes = {};         ///< of cloth: the node of each vertex
};

/// Which nodes can be drawn, and where coordinates start: single precision is enough near the
/// scene's centre.
struct DrawLimits {
  Vector3<double> origin{0, 0, 0};  ///< [m], subtracted
  double largest = 1e6;  ///< [m] from the origin; nodes beyond are left out like non-finite ones
};

/// A cloth with smooth normals, vertex i is node i. Triangles with a node that is not finite or out
/// of the limits are left out.
[[nodiscard]] SurfaceMesh cloth_surface(const Triangles& triangles,
                                        ConstMatrix3XRef<double> positions,
                                        const DrawLimits& limits);

/// The same triangles with vertices of their own and barycentric coordinates in extra.
[[nodiscard]] SurfaceMesh with_barycentrics(const SurfaceMesh& mesh);

/// The plane y = 0 around the origin, finer near it.
[[nodiscard]] SurfaceMesh ground_surface(double extent);

/// A vertex of a body at its place on it [m].
[[nodiscard]] SurfaceVertex body_vertex(const Vector3<double>& position,
                                        const Vector3<double>& normal,
                                        const Eigen::Vector2d& texture_coordinates);

/// Adds a grid of (columns + 1) x (rows + 1) vertices; make(u, v) with u, v from 0 to 1, and u x v
/// is the outside.
template <class Make>
void append_patch(SurfaceMesh& mesh, int columns, int rows, const Make& make) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  const auto stride = static_cast<std::uint32_t>(columns + 1);
  for (int j = 0; j <= rows; ++j) {
    for (int i = 0; i <= columns; ++i) {
      mesh.vertices.push_back(
          make(static_cast<double>(i) / columns, static_cast<double>(j) / rows));
    }
  }
  for (std::uint32_t j = 0; j < static_cast<std::uint32_t>(rows); ++j) {
    for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(columns); ++i) {
      const std::uint32_t a = first + j * stride + i;
      mesh.indices.insert(mesh.indices.end(),
                          {a, a + 1, a + stride, a + 1, a + stride + 1, a + stride});
    }
  }
}

}  // namespace weft::scenes
