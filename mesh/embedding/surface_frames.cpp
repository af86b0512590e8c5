#include <weft/mesh/embedding/surface_frames.hpp>

#include <Eigen/Geometry>
#include <Eigen/LU>

namespace weft {
namespace {

/// Two edges and the unit normal; zeros in place of a normal that does not exist.
Matrix3<double> triangle_frame(ConstMatrix3XRef<double> positions, const Eigen::Vector3i& nodes,
                               double& double_area) {
  Matrix3<double> frame;
  frame.col(0) = positions.col(nodes[1]) - positions.col(nodes[0]);
  frame.col(1) = positions.col(nodes[2]) - positions.col(nodes[0]);
  const Vector3<double> normal = frame.col(0).cross(frame.col(1));
  double_area = normal.norm();
  // Comparison that is false for what is not finite: such a triangle must show, not vanish.
  frame.col(2) =
      double_area == 0 ? Vector3<double>(0, 0, 0) : Vector3<double>(normal / double_area);
  return frame;
}

}  // namespace

SurfaceFrames::SurfaceFrames(ConstMatrix3XRef<double> rest_positions, const Triangles& triangles)
    : inverses_(3, 3 * triangles.cols()), areas_(triangles.cols()) {
  for (Eigen::Index t = 0; t < triangles.cols(); ++t) {
    double double_area = 0;
    const Matrix3<double> frame = triangle_frame(rest_positions, triangles.col(t), double_area);
    areas_[t] = 0.5 * double_area;
    inverses_.middleCols<3>(3 * t) = frame.inverse();
  }
  change_nodes(triangles, static_cast<int>(rest_positions.cols()));
}

void SurfaceFrames::change_nodes(const Triangles& triangles, int num_nodes) {
  triangles_ = triangles;
  inverse_areas_ = VectorX<double>::Zero(num_nodes);
  for (Eigen::Index t = 0; t < triangles_.cols(); ++t) {
    for (const int node : triangles_.col(t)) inverse_areas_[node] += areas_[t];
  }
  for (double& area : inverse_areas_) area = area > 0 ? 1 / area : 0;
}

void SurfaceFrames::compute(ConstMatrix3XRef<double> positions, Matrix3XRef<double> frames) const {
  frames.setZero();
  for (Eigen::Index t = 0; t < triangles_.cols(); ++t) {
    double double_area = 0;
    const Eigen::Vector3i nodes = triangles_.col(t);
    const Matrix3<double> frame = triangle_frame(positions, nodes, double_area);
    const Matrix3<double> gradient = frame * inverses_.middleCols<3>(3 * t);
    for (const int node : nodes) {
      frames.middleCols<3>(3 * node) += (areas_[t] * inverse_areas_[node]) * gradient;
    }
  }
}

}  // namespace weft
