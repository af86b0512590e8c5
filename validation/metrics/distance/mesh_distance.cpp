#include <weft/validation/metrics/distance/mesh_distance.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace weft::validation {
namespace {

/// Weights below this count as zero: the nearest place is on an edge or a corner [-].
constexpr double kOnBorder = 1e-9;

double angle_between(const Vector3<double>& a, const Vector3<double>& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

/// Weights of the nearest place on a segment, 0 at p to 1 at q.
double nearest_on_segment(const Vector3<double>& point, const Vector3<double>& p,
                          const Vector3<double>& q) {
  const Vector3<double> along = q - p;
  return std::clamp((point - p).dot(along) / along.squaredNorm(), 0.0, 1.0);
}

}  // namespace

MeshDistance::MeshDistance(scenes::MeshShape mesh) : mesh_(std::move(mesh)) {
  const Eigen::Index count = mesh_.triangles.cols();
  face_normals_.resize(3, count);
  point_normals_ = Matrix3X<double>::Zero(3, mesh_.points.cols());
  neighbors_ = Triangles::Constant(3, count, -1);
  centers_.resize(3, count);
  radii_.resize(count);
  std::map<std::pair<int, int>, std::pair<Eigen::Index, int>> edges;
  for (Eigen::Index t = 0; t < count; ++t) {
    Matrix3<double> x;
    for (int k = 0; k < 3; ++k) x.col(k) = mesh_.points.col(mesh_.triangles(k, t));
    face_normals_.col(t) = Vector3<double>(x.col(1) - x.col(0))
                               .cross(Vector3<double>(x.col(2) - x.col(0)))
                               .normalized();
    centers_.col(t) = x.rowwise().mean();
    radii_[t] = (x.colwise() - centers_.col(t)).colwise().norm().maxCoeff();
    for (int k = 0; k < 3; ++k) {
      const int from = mesh_.triangles(k, t);
      const int to = mesh_.triangles((k + 1) % 3, t);
      const Vector3<double> side = x.col((k + 1) % 3) - x.col(k);
      const Vector3<double> other = x.col((k + 2) % 3) - x.col(k);
      point_normals_.col(from) += angle_between(side, other) * face_normals_.col(t);
      edges[{from, to}] = {t, k};
      const auto twin = edges.find({to, from});
      if (twin == edges.end()) continue;
      neighbors_(k, t) = static_cast<int>(twin->second.first);
      neighbors_(twin->second.second, twin->second.first) = static_cast<int>(t);
    }
  }
}

MeshDistance::Nearest MeshDistance::nearest_on(Eigen::Index t, const Vector3<double>& point) const {
  Matrix3<double> x;
  for (int k = 0; k < 3; ++k) x.col(k) = mesh_.points.col(mesh_.triangles(k, t));
  const Vector3<double> normal =
      Vector3<double>(x.col(1) - x.col(0)).cross(Vector3<double>(x.col(2) - x.col(0)));
  Vector3<double> weights;
  for (int k = 0; k < 3; ++k) {
    const Vector3<double> from = x.col((k + 1) % 3);
    const Vector3<double> side = Vector3<double>(x.col((k + 2) % 3)) - from;
    weights[k] = side.cross(Vector3<double>(point - from)).dot(normal) / normal.squaredNorm();
  }
  if (weights.minCoeff() >= 0) {
    const Vector3<double> place = x * weights;
    return {(point - place).norm(), place, weights};
  }
  Nearest best{std::numeric_limits<double>::infinity(), {}, {}};
  for (int k = 0; k < 3; ++k) {
    const int next = (k + 1) % 3;
    const double along = nearest_on_segment(point, x.col(k), x.col(next));
    Vector3<double> on_edge = Vector3<double>::Zero();
    on_edge[k] = 1.0 - along;
    on_edge[next] = along;
    const Vector3<double> place = x * on_edge;
    const double distance = (point - place).norm();
    if (distance < best.distance) best = {distance, place, on_edge};
  }
  return best;
}

Vector3<double> MeshDistance::pseudonormal(Eigen::Index t, const Vector3<double>& weights) const {
  for (int k = 0; k < 3; ++k) {
    if (weights[k] >= 1.0 - kOnBorder) return point_normals_.col(mesh_.triangles(k, t));
  }
  for (int k = 0; k < 3; ++k) {
    if (weights[(k + 2) % 3] > kOnBorder) continue;
    const int neighbor = neighbors_(k, t);
    if (neighbor >= 0) return face_normals_.col(t) + face_normals_.col(neighbor);
  }
  return face_normals_.col(t);
}

double MeshDistance::operator()(const Vector3<double>& point) const {
  Nearest best{std::numeric_limits<double>::infinity(), {}, {}};
  Eigen::Index triangle = 0;
  for (Eigen::Index t = 0; t < mesh_.triangles.cols(); ++t) {
    if ((point - centers_.col(t)).norm() - radii_[t] >= best.distance) continue;
    const Nearest here = nearest_on(t, point);
    if (here.distance >= best.distance) continue;
    best = here;
    triangle = t;
  }
  const bool outside = (point - best.place).dot(pseudonormal(triangle, best.weights)) >= 0;
  return outside ? best.distance : -best.distance;
}

}  // namespace weft::validation
