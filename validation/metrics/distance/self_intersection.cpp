#include <weft/validation/metrics/distance/self_intersection.hpp>

#include <algorithm>
#include <array>
#include <set>
#include <tuple>
#include <utility>

#include <Eigen/Geometry>

namespace weft::validation {
namespace {

using Edge = std::pair<int, int>;

std::vector<Edge> edges_of(const Triangles& triangles) {
  std::set<Edge> edges;
  for (Eigen::Index t = 0; t < triangles.cols(); ++t) {
    for (int k = 0; k < 3; ++k) {
      edges.insert(std::minmax(triangles(k, t), triangles((k + 1) % 3, t)));
    }
  }
  return {edges.begin(), edges.end()};
}

/// Six times the volume of a tetrahedron, positive if d lies before the front of a b c.
double volume(const Vector3<double>& a, const Vector3<double>& b, const Vector3<double>& c,
              const Vector3<double>& d) {
  return (b - a).cross(c - a).dot(d - a);
}

bool pierces(const Vector3<double>& p, const Vector3<double>& q,
             const std::array<Vector3<double>, 3>& t) {
  const double at_p = volume(t[0], t[1], t[2], p);
  const double at_q = volume(t[0], t[1], t[2], q);
  if (!(at_p * at_q < 0)) return false;
  const double u = volume(p, q, t[0], t[1]);
  const double v = volume(p, q, t[1], t[2]);
  const double w = volume(p, q, t[2], t[0]);
  return (u > 0 && v > 0 && w > 0) || (u < 0 && v < 0 && w < 0);
}

struct Span {
  Eigen::AlignedBox3d box;
  int index;
};

/// Calls found(edge, triangle) for all that cut each other, sweeping along x.
template <class Found>
void sweep(ConstMatrix3XRef<double> edge_positions, const std::vector<Edge>& edges,
           ConstMatrix3XRef<double> positions, const Triangles& triangles, Found found) {
  std::vector<Span> spans;
  double widest = 0.0;
  for (Eigen::Index t = 0; t < triangles.cols(); ++t) {
    Span span{{}, static_cast<int>(t)};
    for (const int node : triangles.col(t)) {
      span.box.extend(Vector3<double>(positions.col(node)));
    }
    widest = std::max(widest, span.box.sizes().x());
    spans.push_back(span);
  }
  std::sort(spans.begin(), spans.end(), [](const Span& a, const Span& b) {
    return std::tuple(a.box.min().x(), a.index) < std::tuple(b.box.min().x(), b.index);
  });
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const Vector3<double> p = edge_positions.col(edges[e].first);
    const Vector3<double> q = edge_positions.col(edges[e].second);
    Eigen::AlignedBox3d box(p);
    box.extend(q);
    auto span = std::lower_bound(spans.begin(), spans.end(), box.min().x() - widest,
                                 [](const Span& one, double x) { return one.box.min().x() < x; });
    for (; span != spans.end() && span->box.min().x() <= box.max().x(); ++span) {
      if (!span->box.intersects(box)) continue;
      const auto nodes = triangles.col(span->index);
      const std::array<Vector3<double>, 3> corners{positions.col(nodes[0]), positions.col(nodes[1]),
                                                   positions.col(nodes[2])};
      if (pierces(p, q, corners)) found(edges[e], span->index);
    }
  }
}

}  // namespace

std::vector<Piercing> self_piercings(ConstMatrix3XRef<double> positions,
                                     const Triangles& triangles) {
  std::vector<Piercing> result;
  if (!positions.allFinite()) return result;
  sweep(positions, edges_of(triangles), positions, triangles, [&](const Edge& edge, int t) {
    const auto nodes = triangles.col(t).array();
    if ((nodes == edge.first).any() || (nodes == edge.second).any()) return;
    result.push_back({edge.first, edge.second, t});
  });
  std::sort(result.begin(), result.end(), [](const Piercing& a, const Piercing& b) {
    return std::tie(a.from, a.to, a.triangle) < std::tie(b.from, b.to, b.triangle);
  });
  return result;
}

int count_piercings(ConstMatrix3XRef<double> positions, const Triangles& triangles,
                    ConstMatrix3XRef<double> other_positions, const Triangles& other_triangles) {
  if (!positions.allFinite() || !other_positions.allFinite()) return 0;
  int count = 0;
  const auto found = [&](const Edge&, int) { ++count; };
  sweep(positions, edges_of(triangles), other_positions, other_triangles, found);
  sweep(other_positions, edges_of(other_triangles), positions, triangles, found);
  return count;
}

}  // namespace weft::validation
