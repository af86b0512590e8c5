#include <weft/scenes/import/weld.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>

namespace weft::import {
namespace {

using Cell = std::array<std::int64_t, 3>;

/// Far beyond the cells of any file whose tolerance is above the rounding of its positions.
constexpr double kLargestCell = 1e15;

class Welder {
 public:
  Welder(ConstMatrix3XRef<double> positions, double tolerance)
      : positions_(positions),
        tolerance_(tolerance),
        // Without a tolerance only the bits count: a cell of any size does.
        cell_size_(std::max({tolerance, positions.cwiseAbs().maxCoeff() / kLargestCell, 1e-300})) {}

  /// The vertex whose node this one joins, or itself.
  int first_vertex_at(int vertex) {
    const Cell home = cell_of(vertex);
    int found = vertex;
    for (std::int64_t x = -1; x <= 1; ++x) {
      for (std::int64_t y = -1; y <= 1; ++y) {
        for (std::int64_t z = -1; z <= 1; ++z) {
          found = std::min(found, find_in({home[0] + x, home[1] + y, home[2] + z}, vertex));
        }
      }
    }
    if (found == vertex) cells_[home].push_back(vertex);
    return found;
  }

 private:
  [[nodiscard]] Cell cell_of(int vertex) const {
    Cell cell{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double place = positions_(static_cast<Eigen::Index>(axis), vertex) / cell_size_;
      cell[axis] = static_cast<std::int64_t>(std::floor(place));
    }
    return cell;
  }
  [[nodiscard]] int find_in(const Cell& cell, int vertex) const {
    const auto found = cells_.find(cell);
    if (found == cells_.end()) return vertex;
    for (const int other : found->second) {
      if ((positions_.col(other) - positions_.col(vertex)).norm() <= tolerance_) return other;
    }
    return vertex;
  }

  ConstMatrix3XRef<double> positions_;
  double tolerance_;
  double cell_size_;
  std::map<Cell, std::vector<int>> cells_;  ///< vertices that are the first of their nodes
};

}  // namespace

std::vector<int> weld(ConstMatrix3XRef<double> positions, double tolerance) {
  std::vector<int> nodes(static_cast<std::size_t>(positions.cols()));
  if (nodes.empty()) return nodes;
  Welder welder(positions, tolerance);
  int num_nodes = 0;
  for (std::size_t v = 0; v < nodes.size(); ++v) {
    const auto first = static_cast<std::size_t>(welder.first_vertex_at(static_cast<int>(v)));
    nodes[v] = first == v ? num_nodes++ : nodes[first];
  }
  return nodes;
}

}  // namespace weft::import
