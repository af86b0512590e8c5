#pragma once

// Tested by tests/validation/metrics/distance/shape_distance_test.cpp.

#include <vector>

#include <weft/scenes/shapes/shapes.hpp>

namespace weft::validation {

/// Signed distance to a surface of triangles. The sign is that of the pseudonormal at the nearest
/// place: a triangle's own normal, the sum of two along an edge, the sum weighted by angles at a
/// point; it is right for every closed surface, also where many triangles are equally near.
class MeshDistance {
 public:
  explicit MeshDistance(scenes::MeshShape mesh);

  /// [m], negative behind the surface.
  [[nodiscard]] double operator()(const Vector3<double>& point) const;

 private:
  struct Nearest {
    double distance;          ///< [m], >= 0
    Vector3<double> place;    ///< on the triangle
    Vector3<double> weights;  ///< barycentric
  };
  [[nodiscard]] Nearest nearest_on(Eigen::Index triangle, const Vector3<double>& point) const;
  [[nodiscard]] Vector3<double> pseudonormal(Eigen::Index triangle,
                                             const Vector3<double>& weights) const;

  scenes::MeshShape mesh_;
  Matrix3X<double> face_normals_;   ///< unit
  Matrix3X<double> point_normals_;  ///< sums weighted by angles
  Triangles neighbors_;             ///< beyond the edge from corner k to k + 1; -1: none
  Matrix3X<double> centers_;        ///< of bounding spheres [m]
  VectorX<double> radii_;           ///< [m]
};

}  // namespace weft::validation
