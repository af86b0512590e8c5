#pragma once

// Tested by tests/mesh/embedding/cloth_embedding_test.cpp.

#include <weft/mesh/embedding/triangle_tree.hpp>

namespace weft {

/// Foot points of a surface at rest. The foot of a point is where the normal that is interpolated over the triangle points at it
/// (Kobbelt, Vorsatz and Seidel 1999, "Multiresolution hierarchies on unstructured triangle meshes"). Unlike the nearest point it
/// moves without a jump where the point passes a fold on its hollow side, as long as it is nearer than the fold's center of curvature.
class FootPoints {
 public:
  /// normals: unit or zero, of the nodes. There must be a triangle.
  FootPoints(const Matrix3X<double>& positions, const Triangles& triangles,
             Matrix3X<double> normals);

  /// The foot of a point [m]; where it has none, beyond a border or farther than the center of curvature, the nearest point.
  [[nodiscard]] SurfacePoint foot(const Vector3<double>& point) const;
  /// Direction of the interpolated normal, not of unit length [-].
  [[nodiscard]] Vector3<double> normal(const SurfacePoint& point) const;

 private:
  /// Weights of the foot on the plane of one triangle, and the distance in units of the interpolated normal; false: no convergence.
  [[nodiscard]] bool solve(const Vector3<double>& point, int triangle, Vector3<double>& weights,
                           double& height) const;

  Matrix3X<double> positions_;
  Triangles triangles_;
  Matrix3X<double> normals_;
  Triangles
      neighbors_;  ///< behind the edge opposite to each corner; -1: a border, or more than one
  TriangleTree tree_;
};

}  // namespace weft
