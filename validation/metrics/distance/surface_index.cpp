#include <weft/validation/metrics/distance/surface_index.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/core.h>

#include <weft/core/error.hpp>

namespace weft::validation {
namespace {

constexpr int kLeafSize = 4;  ///< triangles per leaf; 2 to 8 measure alike

Eigen::AlignedBox3d box_of(const Triangle& triangle) {
  Eigen::AlignedBox3d box(triangle.a);
  box.extend(triangle.b);
  box.extend(triangle.c);
  return box;
}

}  // namespace

SurfaceIndex::SurfaceIndex(ConstMatrix3XRef<double> positions, const Triangles& triangles) {
  if (triangles.cols() == 0) {
    throw InvalidArgument("surface distance: triangles = 0, expected >= 1");
  }
  if (triangles.minCoeff() < 0 || triangles.maxCoeff() >= positions.cols()) {
    throw InvalidArgument(
        fmt::format("surface distance: triangle corners = {} to {}, expected node indices 0 to {}",
                    triangles.minCoeff(), triangles.maxCoeff(), positions.cols() - 1));
  }
  triangles_.reserve(static_cast<std::size_t>(triangles.cols()));
  for (Eigen::Index t = 0; t < triangles.cols(); ++t) {
    const Triangle corners{positions.col(triangles(0, t)), positions.col(triangles(1, t)),
                           positions.col(triangles(2, t))};
    finite_ = finite_ && corners.a.allFinite() && corners.b.allFinite() && corners.c.allFinite();
    triangles_.push_back(corners);
  }
  if (finite_) build(0, static_cast<int>(triangles_.size()));
}

void SurfaceIndex::build(int first, int count) {
  const std::size_t self = nodes_.size();
  Node& node = nodes_.emplace_back();
  for (int t = first; t < first + count; ++t) {
    node.box.extend(box_of(triangles_[static_cast<std::size_t>(t)]));
  }
  if (count <= kLeafSize) {
    node.first = first;
    node.count = count;
    return;
  }
  Eigen::Index axis = 0;
  node.box.sizes().maxCoeff(&axis);
  const auto begin = triangles_.begin() + first;
  const int half = count / 2;
  std::nth_element(begin, begin + half, begin + count,
                   [axis](const Triangle& l, const Triangle& r) {
                     return l.a[axis] + l.b[axis] + l.c[axis] < r.a[axis] + r.b[axis] + r.c[axis];
                   });
  build(first, half);
  nodes_[self].right = static_cast<int>(nodes_.size());
  build(first + half, count - half);
}

void SurfaceIndex::search(int index, const Vector3<double>& point, double& best) const {
  const Node& node = nodes_[static_cast<std::size_t>(index)];
  for (int t = node.first; t < node.first + node.count; ++t) {
    best = std::min(best, point_triangle_distance(point, triangles_[static_cast<std::size_t>(t)]));
  }
  if (node.count > 0) return;
  int near = index + 1;
  int far = node.right;
  double near_distance = nodes_[static_cast<std::size_t>(near)].box.exteriorDistance(point);
  double far_distance = nodes_[static_cast<std::size_t>(far)].box.exteriorDistance(point);
  if (far_distance < near_distance) {
    std::swap(near, far);
    std::swap(near_distance, far_distance);
  }
  if (near_distance < best) search(near, point, best);
  if (far_distance < best) search(far, point, best);
}

double SurfaceIndex::distance(const Vector3<double>& point) const {
  if (!finite_ || !point.allFinite()) return std::numeric_limits<double>::quiet_NaN();
  double best = std::numeric_limits<double>::infinity();
  search(0, point, best);
  return best;
}

}  // namespace weft::validation
