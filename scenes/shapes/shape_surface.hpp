#pragma once

// Tested by tests/engines/bullet/bullet_shapes_test.cpp, tests/validation/metrics/distance/shape_distance_test.cpp.

#include <weft/scenes/shapes/shapes.hpp>

namespace weft::scenes {

/// The faces of a convex hull, each divided into triangles; its points are those of the shape.
/// O(n^4) at worst: for up to some hundred points. Throws InvalidArgument if all points lie in one
/// plane.
[[nodiscard]] MeshShape hull_surface(const ConvexHullShape& hull);

/// The ground of a height field: 2 triangles per cell, front up.
[[nodiscard]] MeshShape height_field_surface(const HeightFieldShape& field);

/// The surface of any shape but a plane, as triangles in its own frame: for pictures, volumes and
/// Bullet. Round shapes become polyhedra with their points on the surface, of `divisions` sides
/// around. A compound is the surfaces of its parts, hidden ones too. A plane gives no triangle.
[[nodiscard]] MeshShape shape_surface(const Shape& shape, int divisions = 48);

/// Volume, centre and inertia of a homogeneous solid.
struct SolidMoments {
  double volume = 0.0;               ///< [m^3]
  Vector3<double> center{0, 0, 0};   ///< centre of mass [m] in the shape's frame
  Vector3<double> inertia{0, 0, 0};  ///< [m^2] per mass, about axes through the centre along the
                                     ///< frame's; products of inertia are left out
};
/// Exact for a sphere and a box; for other round shapes that of a polyhedron of 96 sides, 0.3 % less.
/// Parts of a compound that overlap count twice. Throws InvalidArgument for a plane, a height field
/// and a mesh: they have no inside, or need not have one.
[[nodiscard]] SolidMoments solid_moments(const Shape& shape);

}  // namespace weft::scenes
