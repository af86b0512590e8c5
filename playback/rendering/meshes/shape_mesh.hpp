#pragma once

#include <Eigen/Geometry>

#include <weft/playback/rendering/meshes/surface_mesh.hpp>

namespace weft::scenes {

/// Surfaces of collider shapes around the origin. All vertices have a place on the body in `extra`
/// and texture coordinates in `value`, unless the comment says otherwise.

[[nodiscard]] SurfaceMesh sphere_surface(double radius);

/// Sides are divided, so that soft light, which is gathered per vertex, has places to vary.
[[nodiscard]] SurfaceMesh box_surface(const Vector3<double>& half_extents);

/// Around the y axis; half_height is that of the straight part. [m]
[[nodiscard]] SurfaceMesh capsule_surface(double radius, double half_height);

/// Around the y axis. [m]
[[nodiscard]] SurfaceMesh cylinder_surface(double radius, double half_height);

/// Around the y axis, tip at +half_height. [m]
[[nodiscard]] SurfaceMesh cone_surface(double radius, double half_height);

/// Triangles of any surface. Normals are smooth where neighbors meet at less than the crease angle
/// [rad]. Texture coordinates are seen along y, one repetition over the size of the body.
[[nodiscard]] SurfaceMesh triangle_surface(ConstMatrix3XRef<double> positions,
                                           const Triangles& triangles, double crease_angle);

/// Appends a surface that stands elsewhere on the body.
void append_surface(SurfaceMesh& mesh, const SurfaceMesh& part, const Eigen::Isometry3d& pose);

}  // namespace weft::scenes
