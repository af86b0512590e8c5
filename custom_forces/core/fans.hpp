#pragma once

#include <array>
#include <vector>

#include <weft/custom_forces/core/cloth_mesh.hpp>

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
class Neighbourhood {
 public:
  /// Throws InvalidArgument for an edge of more than two triangles.
  Neighbourhood(const Triangles& triangles, int num_nodes);

  /// By lower node, then by higher node.
  [[nodiscard]] const std::vector<InnerEdge>& inner_edges() const { return inner_edges_; }
  [[nodiscard]] const std::vector<int>& triangles_of(int node) const {
    return triangles_of_[static_cast<std::size_t>(node)];
  }
  /// Places in inner_edges() of a triangle's edges.
  [[nodiscard]] const std::vector<int>& inner_edges_of(int triangle) const {
    return inner_edges_of_[static_cast<std::size_t>(triangle)];
  }

 private:
  std::vector<InnerEdge> inner_edges_;
  std::vector<std::vector<int>> triangles_of_;
  std::vector<std::vector<int>> inner_edges_of_;
};

/// Which corners of the triangles stay one node when edges are cut: the nodes of a cut mesh.
class Fans {
 public:
  /// is_cut: of each of the neighbourhood's inner edges.
  Fans(const ClothMesh& mesh, const Neighbourhood& near, const std::vector<bool>& is_cut);

  /// New node numbers of every triangle, 3 x t.
  [[nodiscard]] const Triangles& triangles() const { return triangles_; }
  [[nodiscard]] const std::vector<int>& origins() const { return origins_; }
  /// All new nodes of an old one; itself first.
  [[nodiscard]] const std::vector<int>& copies(int node) const {
    return copies_[static_cast<std::size_t>(node)];
  }
  [[nodiscard]] bool is_split(int node) const { return copies(node).size() > 1; }
  /// The new node at the corner of a triangle where the old node was.
  [[nodiscard]] int copy_at(int triangle, int node) const;
  /// Whether the two sides of an inner edge have a different node at one of its ends.
  [[nodiscard]] bool is_open(const InnerEdge& edge) const;

 private:
  const ClothMesh* mesh_;
  Triangles triangles_;
  std::vector<int> origins_;
  std::vector<std::vector<int>> copies_;
};

}  // namespace weft
