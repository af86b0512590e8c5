#include <weft/mesh/topology/winding.hpp>

#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include <weft/core/index.hpp>

namespace weft {
namespace {

/// The triangles at each edge, in ascending order. Lists at the edge's lower node, and not a map, which takes ten times as long for
/// a mesh of 20,000 triangles.
class TrianglesAtEdges {
 public:
  explicit TrianglesAtEdges(const Triangles& triangles) {
    if (triangles.cols() == 0) return;
    starts_.assign(at(triangles.maxCoeff()) + 2, 0);
    const auto for_edges = [&](const auto& use) {
      for (int t = 0; t < triangles.cols(); ++t) {
        for (int k = 0; k < 3; ++k) {
          const auto [low, high] = std::minmax({triangles(k, t), triangles((k + 1) % 3, t)});
          use(low, Entry{high, t});
        }
      }
    };
    for_edges([&](int low, const Entry& /*entry*/) { ++starts_[at(low) + 1]; });
    for (std::size_t node = 1; node < starts_.size(); ++node) starts_[node] += starts_[node - 1];
    entries_.resize(starts_.back());
    std::vector<std::size_t> ends = starts_;
    for_edges([&](int low, const Entry& entry) { entries_[ends[at(low)]++] = entry; });
    for (std::size_t node = 0; node + 1 < starts_.size(); ++node) {
      const std::span<Entry> entries = of(static_cast<int>(node));
      std::sort(entries.begin(), entries.end());
    }
  }

  /// use(triangle) for each one at the edge between two nodes.
  template <class Use>
  void visit(int one, int two, const Use& use) {
    const auto [low, high] = std::minmax({one, two});
    const std::span<Entry> entries = of(low);
    auto entry = std::lower_bound(entries.begin(), entries.end(), Entry{high, 0});
    for (; entry != entries.end() && entry->first == high; ++entry) use(entry->second);
  }

 private:
  using Entry = std::pair<int, int>;  ///< higher node, triangle

  [[nodiscard]] std::span<Entry> of(int low) {
    return std::span(entries_).subspan(starts_[at(low)], starts_[at(low) + 1] - starts_[at(low)]);
  }

  std::vector<std::size_t> starts_;  ///< of the entries of each node
  std::vector<Entry> entries_;
};

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
  TrianglesAtEdges at_edges(triangles);
  std::vector<bool> is_wound(at(num_triangles), false);
  std::vector<int> pending;
  for (int first = 0; first < num_triangles; ++first) {
    if (is_wound[at(first)]) continue;
    is_wound[at(first)] = true;
    pending.push_back(first);
    while (!pending.empty()) {
      const int t = pending.back();
      pending.pop_back();
      for (int k = 0; k < 3; ++k) {
        const int from = result(k, t);
        const int to = result((k + 1) % 3, t);
        at_edges.visit(from, to, [&](int other) {
          if (is_wound[at(other)]) return;
          is_wound[at(other)] = true;
          if (runs_along(result, other, from, to)) std::swap(result(1, other), result(2, other));
          pending.push_back(other);
        });
      }
    }
  }
  return result;
}

}  // namespace weft
