#pragma once

#include <utility>
#include <vector>

#include <weft/custom_forces/core/fans.hpp>

namespace weft {

/// Where the springs of a mesh go when it is cut (tear.hpp).
class TornSprings {
 public:
  /// The arguments must outlive this object.
  TornSprings(const ClothMesh& mesh, const Neighbourhood& near, const Fans& fans);

  /// The pairs of new nodes, as (copy of i, copy of j), that a spring from i to j becomes; none if
  /// the cut crosses it.
  [[nodiscard]] std::vector<std::pair<int, int>> pairs(int i, int j) const;

 private:
  [[nodiscard]] bool is_touched(int i, int j) const;
  [[nodiscard]] bool touches(int triangle, int i, int j) const;
  [[nodiscard]] std::vector<int> strip(int i, int j) const;
  [[nodiscard]] std::vector<int> surroundings(int i, int j) const;
  [[nodiscard]] bool holds(int triangle, int node) const;
  void pair_up(const std::vector<int>& region, int i, int j,
               std::vector<std::pair<int, int>>& found) const;

  const ClothMesh* mesh_;
  const Neighbourhood* near_;
  const Fans* fans_;
  std::vector<InnerEdge> open_;
};

}  // namespace weft
