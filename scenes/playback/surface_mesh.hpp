#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include <weft/custom_forces/core/types.hpp>

namespace weft::scenes {

/// What the shaders read per vertex.
struct SurfaceVertex {
  Eigen::Vector3f position{0, 0, 0};
  Eigen::Vector3f normal{0, 1, 0};
  Eigen::Vector2f value{0,
                        0};  ///< place on the colour scale, 0 to 1; 1 if there is a value, 0 if not
  Eigen::Vector3f extra{0, 0, 0};  ///< barycentric (wireframe), or place on the body [m]
};

struct SurfaceMesh {
  std::vector<SurfaceVertex> vertices;
  std::vector<std::uint32_t> indices;  ///< 3 per triangle, counter-clockwise seen from the front
};

/// Which nodes can be drawn, and where coordinates start: single precision is enough near the
/// scene's centre.
struct DrawLimits {
  Vector3<double> origin{0, 0, 0};  ///< [m], subtracted
  double largest = 1e6;  ///< [m] from the origin; nodes beyond are left out like non-finite ones
};

/// A cloth with smooth normals. Triangles with a node that is not finite or out of the limits are
/// left out.
[[nodiscard]] SurfaceMesh cloth_surface(const Triangles& triangles,
                                        ConstMatrix3XRef<double> positions,
                                        const DrawLimits& limits);

/// The same triangles with vertices of their own and barycentric coordinates in extra.
[[nodiscard]] SurfaceMesh with_barycentrics(const SurfaceMesh& mesh);

[[nodiscard]] SurfaceMesh sphere_surface(double radius);
/// Sides are divided, so that soft light, which is gathered per vertex, has places to vary.
[[nodiscard]] SurfaceMesh box_surface(const Vector3<double>& half_extents);
/// The plane y = 0 around the origin, finer near it.
[[nodiscard]] SurfaceMesh ground_surface(double extent);

}  // namespace weft::scenes
