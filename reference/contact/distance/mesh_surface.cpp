#include <weft/reference/contact/distance/mesh_surface.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <string>
#include <tuple>

#include <weft/core/error.hpp>
#include <weft/mesh/distance/primitive_distance.hpp>

namespace weft::reference {
namespace {

constexpr int kLeaf = 4;  // triangles that are looked at one by one

[[noreturn]] void refuse(const std::string& what, const std::string& expected) {
  throw InvalidArgument("reference solver, mesh: " + what + ", expected " + expected);
}

Matrix3<double> corners(const Matrix3X<double>& points, const Triangles& triangles,
                        Eigen::Index t) {
  Matrix3<double> result;
  for (int k = 0; k < 3; ++k) result.col(k) = points.col(triangles(k, t));
  return result;
}

}  // namespace

MeshSurface::MeshSurface(const Matrix3X<double>& points, const Triangles& triangles)
    : points_(points), triangles_(triangles) {
  const Eigen::Index count = triangles.cols();
  if (count == 0) refuse("no triangle", "a closed surface");
  if (!points.allFinite()) refuse("points [m] that are not finite", "finite numbers");
  if (triangles.minCoeff() < 0 || triangles.maxCoeff() >= points.cols()) {
    refuse("a triangle with a node that is not there", "0 to " + std::to_string(points.cols() - 1));
  }
  // Points in one place are one corner: mesh files repeat them along seams.
  std::map<std::tuple<double, double, double>, int> corner_at;
  for (int& node : triangles_.reshaped()) {
    const Vector3<double> at = points.col(node);
    node = corner_at.emplace(std::tuple(at.x(), at.y(), at.z()), node).first->second;
  }
  face_normals_.resize(3, count);
  corner_normals_.setZero(3, points.cols());
  std::map<std::pair<int, int>, Eigen::Index> triangle_of;  // by directed edge
  for (Eigen::Index t = 0; t < count; ++t) {
    const Matrix3<double> at = corners(points_, triangles_, t);
    const Vector3<double> normal = (at.col(1) - at.col(0)).cross(at.col(2) - at.col(0));
    if (!(normal.norm() > 0.0)) refuse("triangle " + std::to_string(t) + " without area", "none");
    face_normals_.col(t) = normal.normalized();
    for (int k = 0; k < 3; ++k) {
      const int from = triangles_(k, t), to = triangles_((k + 1) % 3, t);
      if (!triangle_of.emplace(std::pair(from, to), t).second) {
        refuse(
            "edge " + std::to_string(from) + "-" + std::to_string(to) + " twice in one direction",
            "a closed surface of one orientation");
      }
      const Vector3<double> a = at.col((k + 1) % 3) - at.col(k);
      const Vector3<double> b = at.col((k + 2) % 3) - at.col(k);
      const double angle = std::atan2(a.cross(b).norm(), a.dot(b));
      corner_normals_.col(from) += angle * face_normals_.col(t);
    }
  }
  for (auto& normals : edge_normals_) normals.resize(3, count);
  for (const auto& [edge, t] : triangle_of) {
    const auto other = triangle_of.find({edge.second, edge.first});
    if (other == triangle_of.end()) {
      refuse("edge " + std::to_string(edge.first) + "-" + std::to_string(edge.second) +
                 " with one triangle",
             "a closed surface");
    }
    for (std::size_t k = 0; k < 3; ++k) {
      if (triangles_(static_cast<int>(k), t) != edge.first) continue;
      edge_normals_[k].col(t) = face_normals_.col(t) + face_normals_.col(other->second);
    }
  }
  order_.resize(static_cast<std::size_t>(count));
  std::iota(order_.begin(), order_.end(), 0);
  build(0, static_cast<int>(count));
}

int MeshSurface::build(int first, int last) {
  const int index = static_cast<int>(boxes_.size());
  boxes_.emplace_back();
  Box box{.first = first, .last = last};
  for (int i = first; i < last; ++i) {
    const Matrix3<double> at = corners(points_, triangles_, order_[static_cast<std::size_t>(i)]);
    for (int k = 0; k < 3; ++k) box.bounds.extend(Vector3<double>(at.col(k)));
  }
  if (last - first > kLeaf) {
    int axis = 0;
    box.bounds.sizes().maxCoeff(&axis);
    const int middle = (first + last) / 2;
    const auto centre = [&](int t) { return corners(points_, triangles_, t).row(axis).sum(); };
    std::nth_element(
        order_.begin() + first, order_.begin() + middle, order_.begin() + last,
        [&](int a, int b) { return std::pair(centre(a), a) < std::pair(centre(b), b); });
    build(first, middle);
    box.right = build(middle, last);
  }
  boxes_[static_cast<std::size_t>(index)] = box;
  return index;
}

void MeshSurface::visit(int index, const Vector3<double>& point, double& least, int& nearest,
                        Vector3<double>& weights) const {
  const Box& box = boxes_[static_cast<std::size_t>(index)];
  if (box.bounds.squaredExteriorDistance(point) > least) return;
  if (box.right != 0) {
    const auto distance = [&](int child) {
      return boxes_[static_cast<std::size_t>(child)].bounds.squaredExteriorDistance(point);
    };
    const bool right_first = distance(box.right) < distance(index + 1);
    visit(right_first ? box.right : index + 1, point, least, nearest, weights);
    visit(right_first ? index + 1 : box.right, point, least, nearest, weights);
    return;
  }
  for (int i = box.first; i < box.last; ++i) {
    const int t = order_[static_cast<std::size_t>(i)];
    const Matrix3<double> at = corners(points_, triangles_, t);
    const Vector3<double> on = nearest_on_triangle(point, at);
    const double squared = (at * on - point).squaredNorm();
    if (squared < least || (squared == least && t < nearest)) {
      least = squared;
      nearest = t;
      weights = on;
    }
  }
}

SurfaceDistance MeshSurface::distance(const Vector3<double>& point) const {
  double least = std::numeric_limits<double>::infinity();
  int t = std::numeric_limits<int>::max();
  Vector3<double> weights(1, 0, 0);
  visit(0, point, least, t, weights);
  if (t == std::numeric_limits<int>::max()) {  // a point that is not finite
    return {std::numeric_limits<double>::quiet_NaN(), Vector3<double>::UnitX()};
  }
  const Matrix3<double> at = corners(points_, triangles_, t);
  Vector3<double> pseudonormal = face_normals_.col(t);
  for (int k = 0; k < 3; ++k) {
    const int next = (k + 1) % 3, far = (k + 2) % 3;
    if (weights[k] == 1.0) pseudonormal = corner_normals_.col(triangles_(k, t));
    if (weights[far] == 0.0 && weights[k] > 0.0 && weights[next] > 0.0) {
      pseudonormal = edge_normals_[static_cast<std::size_t>(k)].col(t);
    }
  }
  const Vector3<double> away = point - at * weights;
  const double distance = std::sqrt(least);
  const double side = away.dot(pseudonormal) < 0.0 ? -1.0 : 1.0;
  // Too near to tell a direction from rounding: as at the surface.
  const double rounding = 1e-14 * (point.cwiseAbs().maxCoeff() + at.cwiseAbs().maxCoeff());
  if (distance <= rounding) return {side * distance, pseudonormal.normalized()};
  return {side * distance, side / distance * away};
}

}  // namespace weft::reference
