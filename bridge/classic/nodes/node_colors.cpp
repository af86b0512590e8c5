#include <weft/bridge/classic/nodes/node_colors.hpp>

#include <algorithm>
#include <map>
#include <utility>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {
namespace {

using Neighbors = std::vector<std::vector<int>>;

void couple(const std::vector<int>& group, Neighbors& neighbors) {
  for (const int a : group) {
    for (const int b : group) {
      if (a != b) neighbors[static_cast<std::size_t>(a)].push_back(b);
    }
  }
}

// Triangles, and pairs of triangles that share an edge.
void couple_triangles(const Triangles& triangles, Neighbors& neighbors) {
  std::map<std::pair<int, int>, std::vector<int>> opposite;
  for (Eigen::Index t = 0; t < triangles.cols(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const int a = triangles(k, t);
      const int b = triangles((k + 1) % 3, t);
      const int c = triangles((k + 2) % 3, t);
      couple({a, b}, neighbors);
      std::vector<int>& others = opposite[std::minmax(a, b)];
      for (const int other : others) couple({other, c}, neighbors);
      others.push_back(c);
    }
  }
}

// A connection feels the frame of its node, and so the nodes of all triangles around it.
void couple_connections(const ClothMesh& mesh, Neighbors& neighbors) {
  for (const ConnectionSet& set : mesh.connection_sets) {
    for (Eigen::Index c = 0; c < set.connections.cols(); ++c) {
      const int node = set.connections(0, c);
      std::vector<int> group = {node, set.connections(1, c)};
      for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
        if ((mesh.triangles.col(t).array() != node).all()) continue;
        for (int k = 0; k < 3; ++k) group.push_back(mesh.triangles(k, t));
      }
      couple(group, neighbors);
    }
  }
}

Neighbors neighbors_of(const ClothMesh& mesh) {
  Neighbors neighbors(static_cast<std::size_t>(mesh.num_nodes()));
  for (const EdgeSet& set : mesh.edge_sets) {
    for (Eigen::Index e = 0; e < set.edges.cols(); ++e) {
      couple({set.edges(0, e), set.edges(1, e)}, neighbors);
    }
  }
  for (const LineSet& set : mesh.line_sets) {
    for (Eigen::Index l = 0; l < set.triples.cols(); ++l) {
      couple({set.triples(0, l), set.triples(1, l), set.triples(2, l)}, neighbors);
    }
  }
  couple_triangles(mesh.triangles, neighbors);
  couple_triangles(mesh.crossed_triangles, neighbors);
  couple_connections(mesh, neighbors);
  return neighbors;
}

}  // namespace

std::vector<std::vector<int>> node_colors(const ClothMesh& mesh) {
  const Neighbors neighbors = neighbors_of(mesh);
  std::vector<int> color_of(neighbors.size(), -1);
  std::vector<std::vector<int>> colors;
  for (std::size_t node = 0; node < neighbors.size(); ++node) {
    std::vector<bool> taken(colors.size() + 1, false);
    for (const int other : neighbors[node]) {
      const int color = color_of[static_cast<std::size_t>(other)];
      if (color >= 0) taken[static_cast<std::size_t>(color)] = true;
    }
    const auto color = std::find(taken.begin(), taken.end(), false) - taken.begin();
    if (color == static_cast<std::ptrdiff_t>(colors.size())) colors.emplace_back();
    color_of[node] = static_cast<int>(color);
    colors[static_cast<std::size_t>(color)].push_back(static_cast<int>(node));
  }
  return colors;
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
