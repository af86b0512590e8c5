#pragma once

// Tested by tests/reference/shapes_test.cpp.

#include <array>
#include <vector>

#include <weft/core/eigen_alignment.hpp>

#include <Eigen/Geometry>

#include <weft/core/types.hpp>
#include <weft/reference/contact/distance/signed_distance.hpp>

namespace weft::reference {

/// A closed surface of triangles, prepared for distances: the nearest triangle by a tree of boxes,
/// and inside or outside by the angle-weighted pseudonormal of the nearest face, edge or corner
/// (Baerentzen and Aanaes 2005).
class MeshSurface {
 public:
  /// points 3 x n [m], finite, equal ones count as one; triangles 3 x t, counter-clockwise seen from
  /// outside. Throws
  /// InvalidArgument for no triangle, a node that is not there, a triangle without area, and an
  /// edge that is not shared by exactly two triangles that run along it in opposite directions.
  MeshSurface(const Matrix3X<double>& points, const Triangles& triangles);

  /// In the frame of the points; exact, negative inside. On the surface the normal is the
  /// pseudonormal of where it is.
  [[nodiscard]] SurfaceDistance distance(const Vector3<double>& point) const;

 private:
  struct Box {
    Eigen::AlignedBox3d bounds = {};
    int first = 0, last = 0;  // range of order_; a leaf where right is 0
    int right = 0;            // index of the second half; the first one follows its parent
  };
  int build(int first, int last);
  void visit(int box, const Vector3<double>& point, double& least, int& nearest,
             Vector3<double>& weights) const;

  Matrix3X<double> points_;
  Triangles triangles_;
  Matrix3X<double> face_normals_;
  std::array<Matrix3X<double>, 3> edge_normals_;  // of edge k of each triangle, from corner k
  Matrix3X<double> corner_normals_;               // per node
  std::vector<int> order_;
  std::vector<Box> boxes_;
};

}  // namespace weft::reference
