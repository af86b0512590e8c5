#pragma once

#include <cmath>

#include <Eigen/Geometry>

#include <weft/mesh/cloth_grid.hpp>
#include <weft/mesh/embedding/cloth_embedding.hpp>

namespace weft {

/// A cloth of 11 x 11 nodes, 1 m x 1 m in the plane y = 0, whose normal points up.
inline ClothMesh coarse_cloth() {
  return make_cloth_grid({.nodes = {11, 11}, .size = {1.0, 1.0}});
}

/// A grid of drawn vertices at heights over the plane, that covers the middle of a cloth: half_size [m].
inline DrawnMesh fine_sheet(int nodes, double half_size, double height) {
  const ClothMesh grid = make_cloth_grid(
      {.nodes = {nodes, nodes}, .size = {2 * half_size, 2 * half_size}, .center = {0, height, 0}});
  return {.positions = grid.rest_positions, .triangles = grid.triangles};
}

/// Bends the plane y = 0 around a cylinder of this radius [m] whose axis is along z, above the plane; no length along x changes.
inline Vector3<double> on_cylinder(const Vector3<double>& point, double radius) {
  const double angle = point.x() / radius;
  const double distance = radius - point.y();
  return {distance * std::sin(angle), radius - distance * std::cos(angle), point.z()};
}

inline Matrix3X<double> bent(const Matrix3X<double>& positions, double radius) {
  Matrix3X<double> result(3, positions.cols());
  for (Eigen::Index i = 0; i < positions.cols(); ++i) {
    result.col(i) = on_cylinder(positions.col(i), radius);
  }
  return result;
}

inline ClothPose pose_of(const ClothEmbedding& embedding, const Matrix3X<double>& positions) {
  ClothPose pose = embedding.make_pose();
  embedding.set_pose(positions, pose);
  return pose;
}

inline Matrix3X<double> drawn_positions(const ClothEmbedding& embedding, const ClothPose& pose) {
  Matrix3X<double> positions(3, embedding.num_vertices());
  for (int v = 0; v < embedding.num_vertices(); ++v) {
    positions.col(v) = embedding.vertex(pose, v).position;
  }
  return positions;
}

}  // namespace weft
