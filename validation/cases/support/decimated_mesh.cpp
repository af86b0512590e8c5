#include <weft/validation/cases/support/decimated_mesh.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <utility>

#include <weft/core/error.hpp>

namespace weft::validation {
namespace {

using Cell = std::array<long, 3>;

/// The node that stands for each node.
std::vector<int> representatives(ConstMatrix3XRef<double> rest, const Vector3<double>& corner,
                                 double edge) {
  struct Nearest {
    int node;
    double distance;
  };
  std::map<Cell, Nearest> cells;
  std::vector<Cell> cell_of;
  for (int node = 0; node < rest.cols(); ++node) {
    const Vector3<double> place = (rest.col(node) - corner) / edge;
    const Vector3<double> middle(std::round(place.x()), std::round(place.y()),
                                 std::round(place.z()));
    const Cell cell{std::lround(middle.x()), std::lround(middle.y()), std::lround(middle.z())};
    const double distance = (place - middle).norm();
    const auto [at, is_new] = cells.try_emplace(cell, Nearest{node, distance});
    if (!is_new && distance < at->second.distance) at->second = {node, distance};
    cell_of.push_back(cell);
  }
  std::vector<int> result;
  result.reserve(cell_of.size());
  for (const Cell& cell : cell_of) result.push_back(cells.at(cell).node);
  return result;
}

std::vector<int> distinct(std::vector<int> values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  return values;
}

std::vector<int> remaining_triangles(const Triangles& triangles,
                                     const std::vector<int>& representative,
                                     const std::vector<int>& nodes) {
  const auto index = [&](int node) {
    const int kept = representative[static_cast<std::size_t>(node)];
    return static_cast<int>(std::lower_bound(nodes.begin(), nodes.end(), kept) - nodes.begin());
  };
  std::vector<int> result;
  std::set<std::array<int, 3>> seen;
  for (int t = 0; t < triangles.cols(); ++t) {
    const std::array<int, 3> corners{index(triangles(0, t)), index(triangles(1, t)),
                                     index(triangles(2, t))};
    if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]) continue;
    std::array<int, 3> sorted = corners;
    std::sort(sorted.begin(), sorted.end());
    if (seen.insert(sorted).second) result.insert(result.end(), corners.begin(), corners.end());
  }
  return result;
}

}  // namespace

DecimatedMesh decimate(ConstMatrix3XRef<double> rest_positions, const Triangles& triangles,
                       int max_nodes) {
  if (max_nodes < 1) throw InvalidArgument("decimate: max_nodes must be at least 1");
  std::vector<int> representative(static_cast<std::size_t>(rest_positions.cols()));
  std::iota(representative.begin(), representative.end(), 0);
  std::vector<int> nodes = representative;
  if (rest_positions.cols() > max_nodes) {
    const Vector3<double> corner = rest_positions.rowwise().minCoeff();
    const double size = (rest_positions.rowwise().maxCoeff() - corner).maxCoeff();
    // A surface with max_nodes nodes has at most as many cells along its longest side.
    for (int cells = max_nodes; static_cast<int>(nodes.size()) > max_nodes;
         cells -= std::max(1, cells / 50)) {
      const double edge = cells > 0 ? size / cells : 4 * size + 1;  // the last one holds everything
      representative = representatives(rest_positions, corner, edge);
      nodes = distinct(representative);
    }
  }
  DecimatedMesh result;
  result.triangles = remaining_triangles(triangles, representative, nodes);
  result.nodes = std::move(nodes);
  return result;
}

}  // namespace weft::validation
