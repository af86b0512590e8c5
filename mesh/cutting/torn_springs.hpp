#pragma once

// Tested by tests/mesh/cutting/tear_test.cpp.

#include <array>
#include <utility>
#include <vector>

#include <weft/mesh/cutting/fans.hpp>

namespace weft {

/// Where the springs of a mesh go when it is cut (tear.hpp).
class TornSprings {
 public:
  /// The arguments must outlive this object.
  TornSprings(const ClothMesh& mesh, const Neighborhood& near, const Fans& fans);

  /// Whether the cut may change a spring from i to j: false says that it stays as it is.
  [[nodiscard]] bool is_touched(int i, int j) const;
  /// The pairs of new nodes, as (copy of i, copy of j), that a spring from i to j becomes; none if
  /// the cut crosses it.
  [[nodiscard]] std::vector<std::pair<int, int>> pairs(int i, int j) const;

 private:
  /// A box with sides along the axes [m].
  struct Box {
    Vector3<double> low;
    Vector3<double> high;
  };
  void sort_into_slices();
  void count_slices(int axis, double reach);
  [[nodiscard]] unsigned slice_of(int axis, double coordinate) const;
  /// Whether any open edge reaches into a slice of that axis that a spring from i to j meets.
  [[nodiscard]] bool meets_slices(int axis, int i, int j) const;
  [[nodiscard]] Box box_of(int i, int j) const;
  [[nodiscard]] bool meets_open_edge(int i, int j) const;
  [[nodiscard]] bool touches(int triangle, int i, int j) const;
  [[nodiscard]] std::vector<int> strip(int i, int j) const;
  [[nodiscard]] std::vector<int> surroundings(int i, int j) const;
  [[nodiscard]] bool holds(int triangle, int node) const;
  void pair_up(const std::vector<int>& region, int i, int j,
               std::vector<std::pair<int, int>>& found) const;

  const ClothMesh* mesh_;
  const Neighborhood* near_;
  const Fans* fans_;
  std::vector<InnerEdge> open_;
  std::vector<Box> open_boxes_;  ///< at rest
  // Space is cut into slices across each axis, so that most springs are told to be far from all open edges.
  static constexpr unsigned kSlices = 64;
  /// How many slices that an open edge reaches into lie before a node's slice, and up to it.
  struct OpenSlices {
    unsigned char before;
    unsigned char through;
  };
  Box whole_;                                          ///< of all nodes
  std::array<std::vector<OpenSlices>, 3> open_until_;  ///< of each node
};

}  // namespace weft
