#include <weft/custom_forces/core/fans.hpp>

#include <algorithm>
#include <numeric>
#include <string>

#include <weft/custom_forces/core/error.hpp>

namespace weft {
namespace {

struct Side {
  int first;
  int second;
  int triangle;
  auto operator<=>(const Side&) const = default;  // NOLINT(modernize-use-nullptr): of its own text
};

/// Sets of corners that grow together; a set goes by its lowest corner.
class CornerSets {
 public:
  explicit CornerSets(std::size_t size) : parent_(size) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }
  int find(int corner) {
    while (parent_[static_cast<std::size_t>(corner)] != corner) {
      int& parent = parent_[static_cast<std::size_t>(corner)];
      parent = parent_[static_cast<std::size_t>(parent)];
      corner = parent;
    }
    return corner;
  }
  void join(int a, int b) {
    const auto [low, high] = std::minmax({find(a), find(b)});
    parent_[static_cast<std::size_t>(high)] = low;
  }

 private:
  std::vector<int> parent_;
};

int corner_of(const Triangles& triangles, int triangle, int node) {
  int corner = 0;
  while (corner < 2 && triangles(corner, triangle) != node) ++corner;
  return 3 * triangle + corner;
}

}  // namespace

Neighbourhood::Neighbourhood(const Triangles& triangles, int num_nodes)
    : triangles_of_(static_cast<std::size_t>(num_nodes)),
      inner_edges_of_(static_cast<std::size_t>(triangles.cols())) {
  std::vector<Side> sides;
  for (int t = 0; t < static_cast<int>(triangles.cols()); ++t) {
    for (int corner = 0; corner < 3; ++corner) {
      const auto [a, b] = std::minmax({triangles(corner, t), triangles((corner + 1) % 3, t)});
      sides.push_back({a, b, t});
      triangles_of_[static_cast<std::size_t>(triangles(corner, t))].push_back(t);
    }
  }
  std::sort(sides.begin(), sides.end());
  const auto same_edge = [&](std::size_t i, std::size_t k) {
    return k < sides.size() && sides[i].first == sides[k].first &&
           sides[i].second == sides[k].second;
  };
  for (std::size_t i = 0; i + 1 < sides.size(); ++i) {
    if (!same_edge(i, i + 1)) continue;
    if (same_edge(i, i + 2)) {
      throw InvalidArgument("tear: the edge between nodes " + std::to_string(sides[i].first) +
                            " and " + std::to_string(sides[i].second) +
                            " belongs to more than two triangles, expected at most 2");
    }
    for (const std::size_t k : {i, i + 1}) {
      inner_edges_of_[static_cast<std::size_t>(sides[k].triangle)].push_back(
          static_cast<int>(inner_edges_.size()));
    }
    inner_edges_.push_back(
        {sides[i].first, sides[i].second, {sides[i].triangle, sides[i + 1].triangle}});
    ++i;
  }
}

Fans::Fans(const ClothMesh& mesh, const Neighbourhood& near, const std::vector<bool>& is_cut)
    : mesh_(&mesh), triangles_(mesh.triangles) {
  CornerSets sets(static_cast<std::size_t>(mesh.triangles.size()));
  for (std::size_t e = 0; e < is_cut.size(); ++e) {
    if (is_cut[e]) continue;
    const InnerEdge& edge = near.inner_edges()[e];
    for (const int node : {edge.first, edge.second}) {
      sets.join(corner_of(mesh.triangles, edge.triangles[0], node),
                corner_of(mesh.triangles, edge.triangles[1], node));
    }
  }
  int num_nodes = mesh.num_nodes();
  for (int node = 0; node < mesh.num_nodes(); ++node) {
    copies_.push_back({node});
    std::vector<int> roots;
    for (const int t : near.triangles_of(node)) {
      const int corner = corner_of(mesh.triangles, t, node);
      const int root = sets.find(corner);
      const auto place = std::find(roots.begin(), roots.end(), root) - roots.begin();
      if (place == std::ssize(roots)) {
        roots.push_back(root);
        if (place > 0) {
          copies_.back().push_back(num_nodes++);
          origins_.push_back(node);
        }
      }
      triangles_(corner % 3, t) = copies_.back()[static_cast<std::size_t>(place)];
    }
  }
}

int Fans::copy_at(int triangle, int node) const {
  return triangles_(corner_of(mesh_->triangles, triangle, node) % 3, triangle);
}

bool Fans::is_open(const InnerEdge& edge) const {
  const auto differs = [&](int node) {
    return copy_at(edge.triangles[0], node) != copy_at(edge.triangles[1], node);
  };
  return differs(edge.first) || differs(edge.second);
}

}  // namespace weft
