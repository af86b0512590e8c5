#include <weft/mesh/distance/primitive_distance.hpp>

#include <algorithm>

#include <Eigen/Geometry>

namespace weft {
namespace {

/// Part of the way from a to b at which the line is nearest to a point, 0 to 1.
double nearest_part(const Vector3<double>& point, const Vector3<double>& a,
                    const Vector3<double>& b) {
  const Vector3<double> edge = b - a;
  const double squared_length = edge.squaredNorm();
  if (!(squared_length > 0.0)) return 0.0;
  return std::clamp((point - a).dot(edge) / squared_length, 0.0, 1.0);
}

}  // namespace

Vector3<double> nearest_on_triangle(const Vector3<double>& point, const Matrix3<double>& triangle) {
  const Vector3<double> a = triangle.col(0);
  const Vector3<double> ab = triangle.col(1) - a;
  const Vector3<double> ac = triangle.col(2) - a;
  const Vector3<double> normal = ab.cross(ac);
  const double area = normal.squaredNorm();
  if (area > 0.0) {
    const Vector3<double> ap = point - a;
    const double v = ap.cross(ac).dot(normal) / area;
    const double w = ab.cross(ap).dot(normal) / area;
    if (v >= 0.0 && w >= 0.0 && v + w <= 1.0) return {1.0 - v - w, v, w};
  }
  Vector3<double> best(1, 0, 0);
  double least = -1.0;
  for (int k = 0; k < 3; ++k) {
    const int next = (k + 1) % 3;
    const double part = nearest_part(point, triangle.col(k), triangle.col(next));
    Vector3<double> weights = Vector3<double>::Zero();
    weights[k] = 1.0 - part;
    weights[next] = part;
    const double squared = (triangle * weights - point).squaredNorm();
    if (least < 0.0 || squared < least) {
      least = squared;
      best = weights;
    }
  }
  return best;
}

Nearest nearest_point_triangle(const FourPoints& points) {
  const Vector3<double> on = nearest_on_triangle(points.col(0), points.rightCols<3>());
  return {{1.0, -on[0], -on[1], -on[2]}, points.col(0) - points.rightCols<3>() * on};
}

Nearest nearest_edges(const FourPoints& points) {
  const Vector3<double> a = points.col(0), b = points.col(1);
  const Vector3<double> c = points.col(2), d = points.col(3);
  const Vector3<double> first = b - a, second = d - c, between = a - c;
  const double ff = first.squaredNorm(), ss = second.squaredNorm(), fs = first.dot(second);
  const double determinant = ff * ss - fs * fs;
  // Candidates: where both lines are nearest, if that is inside both edges, and each end of one edge
  // against the other edge. The smallest distance is one of them.
  std::array<std::pair<double, double>, 5> parts{{{0.0, nearest_part(a, c, d)},
                                                  {1.0, nearest_part(b, c, d)},
                                                  {nearest_part(c, a, b), 0.0},
                                                  {nearest_part(d, a, b), 1.0},
                                                  {-1.0, 0.0}}};
  if (determinant > 0.0) {
    const double s = (fs * second.dot(between) - ss * first.dot(between)) / determinant;
    const double t = (ff * second.dot(between) - fs * first.dot(between)) / determinant;
    if (s >= 0.0 && s <= 1.0 && t >= 0.0 && t <= 1.0) parts[4] = {s, t};
  }
  Nearest best;
  double least = -1.0;
  for (const auto& [s, t] : parts) {
    if (s < 0.0) continue;
    const Vector3<double> separation = between + s * first - t * second;
    if (least < 0.0 || separation.squaredNorm() < least) {
      least = separation.squaredNorm();
      best = {{1.0 - s, s, t - 1.0, -t}, separation};
    }
  }
  return best;
}

}  // namespace weft
