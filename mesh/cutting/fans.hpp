#pragma once

// Tested by tests/mesh/cutting/tear_test.cpp.

#include <array>
#include <span>
#include <vector>

#include <weft/mesh/cloth_mesh.hpp>

namespace weft {

/// An edge that two triangles share.
struct InnerEdge {
  int first;   ///< lower node
  int second;  ///< higher node
  std::array<int, 2> triangles;
  [[nodiscard]] int other(int triangle) const {
    return triangles[0] == triangle ? triangles[1] : triangles[0];
  }
};

/// What is next to what in a triangle mesh.
class Neighborhood {
 public:
  /// Throws InvalidArgument for an edge of more than two triangles.
  Neighborhood(const Triangles& triangles, int num_nodes);

  /// By lower node, then by higher node.
  [[nodiscard]] const std::vector<InnerEdge>& inner_edges() const { return inner_edges_; }
  /// Ascending.
  [[nodiscard]] std::span<const int> triangles_of(int node) const {
    const auto begin = first_triangle_[static_cast<std::size_t>(node)];
    return std::span(triangles_)
        .subspan(begin, first_triangle_[static_cast<std::size_t>(node) + 1] - begin);
  }
  /// Places in inner_edges() of a triangle's edges, ascending.
  [[nodiscard]] std::span<const int> inner_edges_of(int triangle) const {
    const auto t = static_cast<std::size_t>(triangle);
    return std::span(inner_edges_of_[t]).first(num_inner_edges_of_[t]);
  }

 private:
  void sort_triangles(const Triangles& triangles, int num_nodes);
  void find_inner_edges(const Triangles& triangles, int num_nodes);

  std::vector<InnerEdge> inner_edges_;
  std::vector<std::size_t> first_triangle_;  ///< of each node, in triangles_; and the end
  std::vector<int> triangles_;
  std::vector<std::array<int, 3>> inner_edges_of_;
  std::vector<unsigned char> num_inner_edges_of_;
};

/// Which corners of the triangles stay one node when edges are cut: the nodes of a cut mesh.
class Fans {
 public:
  /// is_cut: of each of the neighborhood's inner edges.
  Fans(const ClothMesh& mesh, const Neighborhood& near, const std::vector<bool>& is_cut);

  /// New node numbers of every triangle, 3 x t.
  [[nodiscard]] const Triangles& triangles() const { return triangles_; }
  [[nodiscard]] const std::vector<int>& origins() const { return origins_; }
  /// The old nodes that fall apart, ascending, with all their new nodes; itself first.
  struct SplitNode {
    int node;
    std::vector<int> copies;
  };
  [[nodiscard]] const std::vector<SplitNode>& split_nodes() const { return split_nodes_; }
  [[nodiscard]] bool is_split(int node) const {
    return is_split_[static_cast<std::size_t>(node)] != 0;
  }
  /// The new node at the corner of a triangle where the old node was.
  [[nodiscard]] int copy_at(int triangle, int node) const;
  /// Whether the two sides of an inner edge have a different node at one of its ends.
  [[nodiscard]] bool is_open(const InnerEdge& edge) const;

 private:
  const ClothMesh* mesh_;
  Triangles triangles_;
  std::vector<int> origins_;
  std::vector<SplitNode> split_nodes_;
  std::vector<char> is_split_;
};

}  // namespace weft
