#pragma once

// Tested by tests/validation/metrics/distance/surface_distance_test.cpp.

#include <vector>

#include <Eigen/Geometry>

#include <weft/core/types.hpp>
#include <weft/validation/metrics/distance/point_triangle.hpp>

namespace weft::validation {

/// A triangle surface prepared for many nearest-distance questions: a tree of axis-aligned boxes.
class SurfaceIndex {
 public:
  /// Shapes   positions 3 x n [m], triangles 3 x t, t >= 1
  /// Errors   InvalidArgument for no triangle and for a node index out of range
  SurfaceIndex(ConstMatrix3XRef<double> positions, const Triangles& triangles);

  /// Distance from a point to the surface [m]. NaN if the point or any corner of the surface is not
  /// finite.
  [[nodiscard]] double distance(const Vector3<double>& point) const;

 private:
  struct Node {
    Eigen::AlignedBox3d box;
    int first = 0;  ///< first triangle of a leaf
    int count = 0;  ///< number of triangles; 0 for an inner node
    int right = 0;  ///< second child; the first one follows the node
  };

  void build(int first, int count);
  void search(int node, const Vector3<double>& point, double& best) const;

  std::vector<Triangle> triangles_;  ///< in the order of the leaves
  std::vector<Node> nodes_;
  bool finite_ = true;
};

}  // namespace weft::validation
