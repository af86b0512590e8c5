#include <weft/validation/cases/analytic/statics/lattice_strip.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <utility>
#include <vector>

#include <weft/mesh/topology/hinges.hpp>

namespace weft::validation {

double LatticeDirection::angle() const {
  return std::atan2(p, q) * 180 / std::numbers::pi;
}

double LatticeDirection::period() const {
  return std::hypot(p, q);
}

LatticeDirection nearest_direction(double degrees) {
  constexpr int kLargest = 12;
  LatticeDirection best;
  for (int p = 0; p <= kLargest; ++p) {
    for (int q = 0; q <= kLargest; ++q) {
      if (std::gcd(p, q) != 1) continue;
      const LatticeDirection candidate{p, q};
      const double gain = std::abs(best.angle() - degrees) - std::abs(candidate.angle() - degrees);
      if (gain > 1e-9) best = candidate;
    }
  }
  return best;
}

namespace lattice_strip {
namespace {

using Numbers = std::map<std::pair<int, int>, int>;  ///< of a node by its place in the grid

/// Every cell cut both ways, as far as the triangles have all corners.
void cut_cells(const Numbers& numbers, int reach, ClothMesh& mesh) {
  std::array<std::vector<Eigen::Vector3i>, 2> cuts;
  const auto add = [&](std::size_t cut, std::array<std::pair<int, int>, 3> corners) {
    Eigen::Vector3i nodes;
    for (int k = 0; k < 3; ++k) {
      const auto found = numbers.find(corners[static_cast<std::size_t>(k)]);
      if (found == numbers.end()) return;
      nodes[k] = found->second;
    }
    cuts[cut].push_back(nodes);
  };
  for (int j = -reach; j < reach; ++j) {
    for (int i = -reach; i < reach; ++i) {
      const auto even = static_cast<std::size_t>((i + j) & 1);
      add(even, {{{i, j}, {i + 1, j}, {i + 1, j + 1}}});
      add(even, {{{i, j}, {i + 1, j + 1}, {i, j + 1}}});
      add(1 - even, {{{i, j}, {i + 1, j}, {i, j + 1}}});
      add(1 - even, {{{i + 1, j}, {i + 1, j + 1}, {i, j + 1}}});
    }
  }
  for (std::size_t cut = 0; cut < 2; ++cut) {
    Triangles& triangles = cut == 0 ? mesh.triangles : mesh.crossed_triangles;
    triangles.resize(3, static_cast<Eigen::Index>(cuts[cut].size()));
    for (std::size_t t = 0; t < cuts[cut].size(); ++t) {
      triangles.col(static_cast<Eigen::Index>(t)) = cuts[cut][t];
    }
  }
}

/// Every edge of both cuts once.
void join(ClothMesh& mesh) {
  // Both diagonals: the stiffness of the plane has no favourite cut either.
  Edges first = edges_of_triangles(mesh.triangles);
  const Edges second = edges_of_triangles(mesh.crossed_triangles);
  std::map<std::pair<int, int>, bool> unique;
  for (const Edges* edges : {static_cast<const Edges*>(&first), &second}) {
    for (Eigen::Index e = 0; e < edges->cols(); ++e) {
      unique[{(*edges)(0, e), (*edges)(1, e)}] = true;
    }
  }
  Edges net(2, static_cast<Eigen::Index>(unique.size()));
  Eigen::Index column = 0;
  for (const auto& [edge, present] : unique) net.col(column++) << edge.first, edge.second;
  mesh.edge_sets.push_back({"net", net});
}

}  // namespace
}  // namespace lattice_strip

ClothMesh make_lattice_strip(const LatticeDirection& direction, int cells, double length,
                             double density) {
  using namespace lattice_strip;
  // Rows of nodes are a step apart along x, with one node per period; those up to row 0 are held. A clamp as
  // ragged as that acts this far behind the middle of rows 0 and 1, in cells. At 45 degrees, where the rows are far
  // apart, that is row 0, which is exact; at 5 to 40 degrees a light load showed 0.31 to 0.36.
  const double behind = 0.5 / std::numbers::sqrt2;
  const double period = direction.period();
  const int last_row = static_cast<int>(std::lround((cells - behind) * period + 0.5));
  const double step = length / (last_row - 0.5 + behind * period);
  const double spacing = step * period;
  const double offset = (behind * period - 0.5) * step;
  const int first_row = -static_cast<int>(std::lround(2 * period));
  const double width = 2 * direction.period() * spacing + 8 * spacing;
  const auto row_of = [&](int i, int j) { return i * direction.q - j * direction.p; };
  const auto place_of = [&](int i, int j) {
    return (i * direction.p + j * direction.q) * step;  // along -z
  };
  const int reach = static_cast<int>(std::ceil((length + width) / spacing)) + 4;
  ClothMesh mesh;
  Numbers numbers;
  std::vector<Vector3<double>> places;
  std::vector<double> masses;
  for (int j = -reach; j <= reach; ++j) {
    for (int i = -reach; i <= reach; ++i) {
      const int row = row_of(i, j);
      const double z = place_of(i, j);
      if (row < first_row || row > last_row || z < -width / 2 || z > width / 2) continue;
      numbers[{i, j}] = static_cast<int>(places.size());
      if (row <= 0) mesh.pinned.push_back(static_cast<int>(places.size()));
      places.emplace_back(row * step + offset, 0, -z);
      const bool is_end = row == last_row;
      masses.push_back(density * spacing * spacing * (is_end ? 0.5 : 1.0));
    }
  }
  mesh.rest_positions.resize(3, static_cast<Eigen::Index>(places.size()));
  mesh.masses.resize(static_cast<Eigen::Index>(places.size()));
  for (std::size_t n = 0; n < places.size(); ++n) {
    mesh.rest_positions.col(static_cast<Eigen::Index>(n)) = places[n];
    mesh.masses[static_cast<Eigen::Index>(n)] = masses[n];
  }
  cut_cells(numbers, reach, mesh);
  join(mesh);
  return mesh;
}

}  // namespace weft::validation
