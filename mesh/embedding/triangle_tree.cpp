#include <weft/mesh/embedding/triangle_tree.hpp>

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <utility>

namespace weft {
namespace {

constexpr int kLeafSize = 4;
/// A tree of median splits is no deeper than the bits of an int.
constexpr std::size_t kDeepest = 64;

}  // namespace

Vector3<double> closest_weights(const Vector3<double>& point, const Vector3<double>& a,
                                const Vector3<double>& b, const Vector3<double>& c) {
  const Vector3<double> ab = b - a;
  const Vector3<double> ac = c - a;
  const Vector3<double> ap = point - a;
  const double d1 = ab.dot(ap);
  const double d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return {1, 0, 0};
  const Vector3<double> bp = point - b;
  const double d3 = ab.dot(bp);
  const double d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return {0, 1, 0};
  const double on_c = d1 * d4 - d3 * d2;
  if (on_c <= 0 && d1 >= 0 && d3 <= 0) {
    const double v = d1 / (d1 - d3);
    return {1 - v, v, 0};
  }
  const Vector3<double> cp = point - c;
  const double d5 = ab.dot(cp);
  const double d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return {0, 0, 1};
  const double on_b = d5 * d2 - d1 * d6;
  if (on_b <= 0 && d2 >= 0 && d6 <= 0) {
    const double w = d2 / (d2 - d6);
    return {1 - w, 0, w};
  }
  const double on_a = d3 * d6 - d5 * d4;
  if (on_a <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    const double w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return {0, 1 - w, w};
  }
  const double sum = on_a + on_b + on_c;
  const double v = on_b / sum;
  const double w = on_c / sum;
  return {1 - v - w, v, w};
}

TriangleTree::TriangleTree(Matrix3X<double> positions, Triangles triangles)
    : positions_(std::move(positions)),
      triangles_(std::move(triangles)),
      order_(static_cast<std::size_t>(triangles_.cols())) {
  std::iota(order_.begin(), order_.end(), 0);
  build(0, static_cast<int>(order_.size()));
}

int TriangleTree::build(int first, int count) {
  const auto index = static_cast<int>(boxes_.size());
  Box box;
  const auto begin = order_.begin() + first;
  Eigen::AlignedBox3d centers;
  for (auto t = begin; t != begin + count; ++t) {
    for (const int node : triangles_.col(*t)) {
      box.bounds.extend(Vector3<double>(positions_.col(node)));
    }
    centers.extend(Vector3<double>(positions_(Eigen::all, triangles_.col(*t)).rowwise().mean()));
  }
  boxes_.push_back(box);
  if (count <= kLeafSize) {
    boxes_.back().first = first;
    boxes_.back().count = count;
    return index;
  }
  int axis = 0;
  centers.sizes().maxCoeff(&axis);
  const int half = count / 2;
  std::nth_element(begin, begin + half, begin + count, [&](int s, int t) {
    const double of_s = positions_(axis, triangles_.col(s)).sum();
    const double of_t = positions_(axis, triangles_.col(t)).sum();
    return of_s != of_t ? of_s < of_t : s < t;
  });
  build(first, half);
  const int second = build(first + half, count - half);
  boxes_[static_cast<std::size_t>(index)].second = second;
  return index;
}

SurfacePoint TriangleTree::closest(const Vector3<double>& point) const {
  SurfacePoint best;
  double nearest = std::numeric_limits<double>::infinity();
  std::array<int, kDeepest> pending{};
  std::size_t num_pending = 1;
  while (num_pending > 0) {
    const int index = pending[--num_pending];
    const Box& box = boxes_[static_cast<std::size_t>(index)];
    if (box.bounds.squaredExteriorDistance(point) > nearest) continue;
    if (box.count == 0) {
      const int near = index + 1;
      const auto distance = [&](int b) {
        return boxes_[static_cast<std::size_t>(b)].bounds.squaredExteriorDistance(point);
      };
      const bool swap = distance(box.second) < distance(near);
      pending[num_pending++] = swap ? near : box.second;
      pending[num_pending++] = swap ? box.second : near;
      continue;
    }
    for (int i = box.first; i < box.first + box.count; ++i) {
      const int t = order_[static_cast<std::size_t>(i)];
      const Vector3<double> a = positions_.col(triangles_(0, t));
      const Vector3<double> b = positions_.col(triangles_(1, t));
      const Vector3<double> c = positions_.col(triangles_(2, t));
      const Vector3<double> weights = closest_weights(point, a, b, c);
      const Vector3<double> foot = weights[0] * a + weights[1] * b + weights[2] * c;
      const double distance = (point - foot).squaredNorm();
      if (distance > nearest || (distance == nearest && t > best.triangle)) continue;
      nearest = distance;
      best = {t, weights};
    }
  }
  return best;
}

}  // namespace weft
