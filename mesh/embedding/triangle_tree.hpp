#pragma once

// Tested by tests/mesh/embedding/cloth_embedding_test.cpp.

#include <vector>

#include <Eigen/Geometry>

#include <weft/core/types.hpp>

namespace weft {

/// A point of a surface.
struct SurfacePoint {
  int triangle = -1;
  Vector3<double> weights{0, 0, 0};  ///< barycentric [-]: their sum is 1
};

/// Closest points of a surface: a tree of boxes around triangles, split at the median of the longest side (Ericson 2005, 6.2).
class TriangleTree {
 public:
  /// Keeps copies. There must be a triangle.
  TriangleTree(Matrix3X<double> positions, Triangles triangles);

  /// The point of the surface that is nearest to a point [m]; of triangles equally near that of the lowest number.
  [[nodiscard]] SurfacePoint closest(const Vector3<double>& point) const;

 private:
  struct Box {
    Eigen::AlignedBox3d bounds;
    int first = 0;  ///< in order_
    int count = 0;  ///< of triangles; 0: the next box is one child, the other is second
    int second = 0;
  };
  int build(int first, int count);

  Matrix3X<double> positions_;
  Triangles triangles_;
  std::vector<int> order_;
  std::vector<Box> boxes_;
};

/// Barycentric weights of the point of the triangle a, b, c that is nearest to a point (Ericson 2005, 5.1.5).
[[nodiscard]] Vector3<double> closest_weights(const Vector3<double>& point,
                                              const Vector3<double>& a, const Vector3<double>& b,
                                              const Vector3<double>& c);

}  // namespace weft
