#include <weft/mesh/topology/winding.hpp>

#include <map>
#include <utility>
#include <vector>

namespace weft {
namespace {

/// Whether a triangle runs from one node to the other.
bool runs_along(const Triangles& triangles, int t, int from, int to) {
  for (int k = 0; k < 3; ++k) {
    if (triangles(k, t) == from && triangles((k + 1) % 3, t) == to) return true;
  }
  return false;
}

}  // namespace

Triangles wound_alike(const Triangles& triangles) {
  Triangles result = triangles;
  const auto num_triangles = static_cast<int>(triangles.cols());
  std::map<std::pair<int, int>, std::vector<int>> at_edge;
  for (int t = 0; t < num_triangles; ++t) {
    for (int k = 0; k < 3; ++k) {
      at_edge[std::minmax(triangles(k, t), triangles((k + 1) % 3, t))].push_back(t);
    }
  }
  std::vector<bool> is_wound(static_cast<std::size_t>(num_triangles), false);
  std::vector<int> pending;
  for (int first = 0; first < num_triangles; ++first) {
    if (is_wound[static_cast<std::size_t>(first)]) continue;
    is_wound[static_cast<std::size_t>(first)] = true;
    pending.push_back(first);
    while (!pending.empty()) {
      const int t = pending.back();
      pending.pop_back();
      for (int k = 0; k < 3; ++k) {
        const int from = result(k, t);
        const int to = result((k + 1) % 3, t);
        for (const int other : at_edge[std::minmax(from, to)]) {
          if (is_wound[static_cast<std::size_t>(other)]) continue;
          is_wound[static_cast<std::size_t>(other)] = true;
          if (runs_along(result, other, from, to)) std::swap(result(1, other), result(2, other));
          pending.push_back(other);
        }
      }
    }
  }
  return result;
}

}  // namespace weft
