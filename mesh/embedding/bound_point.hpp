#pragma once

// Tested by tests/mesh/embedding/cloth_embedding_test.cpp.

#include <Eigen/Geometry>

#include <weft/core/types.hpp>
#include <weft/mesh/embedding/foot_point.hpp>

namespace weft {

/// A point of a drawn mesh and the triangle of the cloth that leads it. With weights b_i, node positions x_i, frames F_i
/// (SurfaceFrames) and rest positions X_i the point is at
///
///   x = sum b_i x_i + 1/2 sum b_i F_i (X_b - X_i) + sum b_i F_i d + h n,   X_b = sum b_i X_i
///
/// The first two terms are Phong deformation (James 2020, "Phong deformation: a better C0 interpolant for embedded deformation"):
/// the mean of the linear interpolation and of what the frames of the nodes extrapolate. It is continuous across edges and exact
/// where the cloth is bent to a paraboloid and F_i are its gradients. h is the height of the point above X_b at rest, along the
/// interpolated normal, and is kept: cloth does not get thinner where it is stretched or bent. d is the rest of its displacement
/// from X_b, which is 0 where X_b is its foot (FootPoints), and is not beyond a border. n is the normal of the blended frame
/// F = sum b_i F_i, as all normals: cofactor(F) times the normal at rest.
struct BoundPoint {
  int triangle = 0;
  Vector3<double> weights{0, 0, 0};  ///< b_i [-]; their sum is 1
  Matrix3<double> arms;              ///< column i: b_i ((X_b - X_i) / 2 + d) [m]
  Vector3<double> normal{0, 0, 0};   ///< at rest, unit [-]
  double height = 0.0;               ///< h [m]
};

/// A bound point of a deformed cloth.
struct PlacedPoint {
  Vector3<double> position;   ///< [m]
  Matrix3<double> gradient;   ///< F [-]
  Matrix3<double> cofactors;  ///< of F [-]
};

/// Binds a point at rest to a place of the surface. corners, normals: rest positions [m] and unit normals of the triangle's nodes.
[[nodiscard]] BoundPoint bind_point(const Vector3<double>& point, const SurfacePoint& place,
                                    const Matrix3<double>& corners, const Matrix3<double>& normals);

/// The vector with length 1; 0 stays 0, as a normal of what has collapsed to a line.
[[nodiscard]] inline Vector3<double> unit_or_zero(const Vector3<double>& vector) {
  const double length = vector.norm();
  return length == 0 ? Vector3<double>(0, 0, 0) : Vector3<double>(vector / length);
}

/// Where the point is. positions: 3 x n [m]; frames: 3 x 3n; nodes: of its triangle.
[[nodiscard]] inline PlacedPoint place_point(const BoundPoint& point, const Eigen::Vector3i& nodes,
                                             const Matrix3X<double>& positions,
                                             const Matrix3X<double>& frames) {
  PlacedPoint placed;
  placed.position.setZero();
  placed.gradient.setZero();
  for (int i = 0; i < 3; ++i) {
    const Matrix3<double> frame = frames.middleCols<3>(3 * nodes[i]);
    placed.position += point.weights[i] * positions.col(nodes[i]) + frame * point.arms.col(i);
    placed.gradient += point.weights[i] * frame;
  }
  const Matrix3<double>& f = placed.gradient;
  placed.cofactors.col(0) = f.col(1).cross(f.col(2));
  placed.cofactors.col(1) = f.col(2).cross(f.col(0));
  placed.cofactors.col(2) = f.col(0).cross(f.col(1));
  placed.position += point.height * unit_or_zero(placed.cofactors * point.normal);
  return placed;
}

}  // namespace weft
