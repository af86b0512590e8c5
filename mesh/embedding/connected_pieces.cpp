#include <weft/mesh/embedding/connected_pieces.hpp>

#include <algorithm>
#include <utility>

#include <weft/mesh/embedding/drawn_mesh.hpp>

namespace weft {
namespace {

/// Disjoint sets with the smallest member as their name.
class VertexSets {
 public:
  explicit VertexSets(std::vector<int> parents) : parents_(std::move(parents)) {}

  int find(int vertex) {
    int& parent = parents_[static_cast<std::size_t>(vertex)];
    while (parent != parents_[static_cast<std::size_t>(parent)]) {
      parent = parents_[static_cast<std::size_t>(parent)];
    }
    return parent;
  }

  void join(int first, int second) {
    const int a = find(first);
    const int b = find(second);
    parents_[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
  }

 private:
  std::vector<int> parents_;
};

}  // namespace

std::vector<std::vector<int>> connected_pieces(ConstMatrix3XRef<double> positions,
                                               const Triangles& triangles) {
  VertexSets sets(first_at_place(positions));
  for (Eigen::Index t = 0; t < triangles.cols(); ++t) {
    sets.join(triangles(0, t), triangles(1, t));
    sets.join(triangles(0, t), triangles(2, t));
  }
  std::vector<std::vector<int>> pieces;
  std::vector<std::size_t> piece_of(static_cast<std::size_t>(positions.cols()));
  for (int v = 0; v < static_cast<int>(positions.cols()); ++v) {
    const int first = sets.find(v);
    if (first == v) {
      piece_of[static_cast<std::size_t>(v)] = pieces.size();
      pieces.emplace_back();
    }
    pieces[piece_of[static_cast<std::size_t>(first)]].push_back(v);
  }
  return pieces;
}

}  // namespace weft
