#include <weft/mesh/cutting/fans.hpp>

#include <algorithm>
#include <numeric>
#include <string>

#include <weft/core/error.hpp>

namespace weft {
namespace {

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

// Numbers, not a map or a sort of all sides: cloth that tears is looked through in every frame.
Neighborhood::Neighborhood(const Triangles& triangles, int num_nodes) {
  sort_triangles(triangles, num_nodes);
  find_inner_edges(triangles, num_nodes);
}

void Neighborhood::sort_triangles(const Triangles& triangles, int num_nodes) {
  first_triangle_.assign(static_cast<std::size_t>(num_nodes) + 1, 0);
  for (const int node : triangles.reshaped()) ++first_triangle_[static_cast<std::size_t>(node) + 1];
  std::partial_sum(first_triangle_.begin(), first_triangle_.end(), first_triangle_.begin());
  std::vector<std::size_t> next(first_triangle_.begin(), first_triangle_.end() - 1);
  triangles_.resize(static_cast<std::size_t>(triangles.size()));
  for (Eigen::Index t = 0; t < triangles.cols(); ++t) {
    for (const int node : triangles.col(t)) {
      triangles_[next[static_cast<std::size_t>(node)]++] = static_cast<int>(t);
    }
  }
}

void Neighborhood::find_inner_edges(const Triangles& triangles, int num_nodes) {
  struct Side {
    int second;
    int triangle;
    bool operator<(const Side& other) const {
      return second != other.second ? second < other.second : triangle < other.triangle;
    }
  };
  const auto num_triangles = static_cast<std::size_t>(triangles.cols());
  inner_edges_.reserve(3 * num_triangles / 2);
  inner_edges_of_.resize(num_triangles);
  num_inner_edges_of_.assign(num_triangles, 0);
  std::vector<Side> sides;  // that have the node as their lower end
  for (int node = 0; node < num_nodes; ++node) {
    sides.clear();
    for (const int t : triangles_of(node)) {
      for (const int other : triangles.col(t)) {
        if (other > node) sides.push_back({other, t});
      }
    }
    std::sort(sides.begin(), sides.end());
    for (std::size_t i = 0; i + 1 < sides.size(); ++i) {
      const auto is_same = [&](std::size_t k) {
        return k < sides.size() && sides[i].second == sides[k].second;
      };
      if (!is_same(i + 1)) continue;
      if (is_same(i + 2)) {
        throw InvalidArgument("tear: the edge between nodes " + std::to_string(node) + " and " +
                              std::to_string(sides[i].second) +
                              " belongs to more than two triangles, expected at most 2");
      }
      for (const std::size_t k : {i, i + 1}) {
        const auto t = static_cast<std::size_t>(sides[k].triangle);
        inner_edges_of_[t][num_inner_edges_of_[t]++] = static_cast<int>(inner_edges_.size());
      }
      inner_edges_.push_back({node, sides[i].second, {sides[i].triangle, sides[i + 1].triangle}});
      ++i;
    }
  }
}

Fans::Fans(const ClothMesh& mesh, const Neighborhood& near, const std::vector<bool>& is_cut)
    : mesh_(&mesh),
      triangles_(mesh.triangles),
      is_split_(static_cast<std::size_t>(mesh.num_nodes()), 0) {
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
  std::vector<int> roots;
  std::vector<int> copies;
  for (int node = 0; node < mesh.num_nodes(); ++node) {
    roots.clear();
    copies.assign(1, node);
    for (const int t : near.triangles_of(node)) {
      const int corner = corner_of(mesh.triangles, t, node);
      const int root = sets.find(corner);
      const auto place = std::find(roots.begin(), roots.end(), root) - roots.begin();
      if (place == std::ssize(roots)) {
        roots.push_back(root);
        if (place > 0) {
          copies.push_back(num_nodes++);
          origins_.push_back(node);
        }
      }
      triangles_(corner % 3, t) = copies[static_cast<std::size_t>(place)];
    }
    if (copies.size() == 1) continue;
    is_split_[static_cast<std::size_t>(node)] = 1;
    split_nodes_.push_back({node, copies});
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
