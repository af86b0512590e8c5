#include <weft/mesh/cloth_grid.hpp>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include <weft/core/error.hpp>

namespace weft {
namespace {

using Step = std::array<int, 2>;

void require_grid(bool ok, const std::string& message) {
  if (!ok) throw InvalidArgument("cloth grid: " + message);
}

void check(const ClothGrid& grid) {
  for (int axis = 0; axis < 2; ++axis) {
    require_grid(grid.nodes[axis] >= 2,
                 "nodes = " + std::to_string(grid.nodes[axis]) + ", expected >= 2");
    require_grid(std::isfinite(grid.size[axis]) && grid.size[axis] > 0,
                 "size = " + std::to_string(grid.size[axis]) + " [m], expected > 0 and finite");
  }
  require_grid(static_cast<long long>(grid.nodes[0]) * grid.nodes[1] <= 100'000'000LL,
               "nodes = " + std::to_string(grid.nodes[0]) + " x " + std::to_string(grid.nodes[1]) +
                   ", expected at most 1e8 in all");
  require_grid(
      std::isfinite(grid.total_mass) && grid.total_mass > 0,
      "total_mass = " + std::to_string(grid.total_mass) + " [kg], expected > 0 and finite");
  require_grid(grid.center.allFinite(), "center is not finite, expected three lengths [m]");
  const double u = grid.u_axis.norm();
  const double v = grid.v_axis.norm();
  require_grid(std::isfinite(u) && std::isfinite(v) && u > 0 && v > 0,
               "u_axis or v_axis has no direction, expected finite non-zero vectors");
  // 1e-6 rad: far below anything visible, far above the rounding of hand-written axes.
  require_grid(std::abs(grid.u_axis.dot(grid.v_axis)) <= 1e-6 * u * v,
               "u_axis and v_axis are not perpendicular");
}

Edges edges_of_steps(const ClothGrid& grid, const std::vector<Step>& steps) {
  const auto [columns, rows] = grid.nodes;
  std::vector<int> flat;
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      for (const auto& [di, dj] : steps) {
        const int i2 = i + di;
        const int j2 = j + dj;
        if (i2 < 0 || i2 >= columns || j2 >= rows) continue;
        flat.push_back(j * columns + i);
        flat.push_back(j2 * columns + i2);
      }
    }
  }
  return Eigen::Map<const Edges>(flat.data(), 2, static_cast<Eigen::Index>(flat.size() / 2));
}

/// Three next neighbors along an axis (0: along u, 1: along v), centre in the middle.
Triples lines_along(const ClothGrid& grid, int axis) {
  const auto [columns, rows] = grid.nodes;
  const int di = axis == 0 ? 1 : 0;
  const int dj = 1 - di;
  std::vector<int> flat;
  for (int j = dj; j < rows - dj; ++j) {
    for (int i = di; i < columns - di; ++i) {
      for (const int step : {-1, 0, 1}) flat.push_back((j + step * dj) * columns + i + step * di);
    }
  }
  return Eigen::Map<const Triples>(flat.data(), 3, static_cast<Eigen::Index>(flat.size() / 3));
}

/// Cells cut by diagonals that alternate; phase 1: by the other diagonal of each.
Triangles union_jack(const ClothGrid& grid, int phase) {
  const auto [columns, rows] = grid.nodes;
  Triangles triangles(3, 2 * (columns - 1) * (rows - 1));
  Eigen::Index t = 0;
  for (int j = 0; j + 1 < rows; ++j) {
    for (int i = 0; i + 1 < columns; ++i) {
      const int a = j * columns + i;
      const int b = a + 1;
      const int c = a + columns;
      const int d = c + 1;
      if ((i + j + phase) % 2 == 0) {
        triangles.col(t++) << a, b, d;
        triangles.col(t++) << a, d, c;
      } else {
        triangles.col(t++) << a, b, c;
        triangles.col(t++) << b, d, c;
      }
    }
  }
  return triangles;
}

}  // namespace

std::vector<GridEdgeSet> grid_edge_sets(GridStencil stencil) {
  std::vector<GridEdgeSet> sets = {{"stretch", {{1, 0}, {0, 1}}}, {"shear", {{1, 1}, {-1, 1}}}};
  if (stencil == GridStencil::k12Neighbour) sets.push_back({"bend", {{2, 0}, {0, 2}}});
  if (stencil == GridStencil::k24Neighbour) {
    sets.push_back({"bend", {{2, 0}, {0, 2}, {2, 1}, {-2, 1}, {1, 2}, {-1, 2}, {2, 2}, {-2, 2}}});
  }
  return sets;
}

ClothMesh make_cloth_grid(const ClothGrid& grid) {
  check(grid);
  const auto [columns, rows] = grid.nodes;
  const Vector3<double> u = grid.u_axis.normalized() * grid.size[0];
  const Vector3<double> v = grid.v_axis.normalized() * grid.size[1];
  ClothMesh mesh;
  mesh.rest_positions.resize(3, static_cast<Eigen::Index>(columns) * rows);
  mesh.texture_coordinates.resize(2, mesh.rest_positions.cols());
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      mesh.rest_positions.col(j * columns + i) =
          grid.center + (i / (columns - 1.0) - 0.5) * u + (j / (rows - 1.0) - 0.5) * v;
      mesh.texture_coordinates.col(j * columns + i) << i / (columns - 1.0), j / (rows - 1.0);
    }
  }
  mesh.triangles = union_jack(grid, 0);
  mesh.crossed_triangles = union_jack(grid, 1);
  mesh.line_sets.push_back({"lines_u", lines_along(grid, 0)});
  mesh.line_sets.push_back({"lines_v", lines_along(grid, 1)});
  for (const GridEdgeSet& set : grid_edge_sets(grid.stencil)) {
    mesh.edge_sets.push_back({set.name, edges_of_steps(grid, set.steps)});
  }
  const int num_nodes = mesh.num_nodes();
  if (grid.lumping == MassLumping::kUniform) {
    mesh.masses = VectorX<double>::Constant(num_nodes, grid.total_mass / num_nodes);
  } else {
    // By cell quarters and not by triangles: the alternating diagonals would give corner nodes 1/6
    // or 1/3 of a cell.
    const double cell_mass = grid.total_mass / ((columns - 1.0) * (rows - 1.0));
    mesh.masses.resize(num_nodes);
    for (int j = 0; j < rows; ++j) {
      for (int i = 0; i < columns; ++i) {
        const double share_u = (i == 0 || i == columns - 1) ? 0.5 : 1.0;
        const double share_v = (j == 0 || j == rows - 1) ? 0.5 : 1.0;
        mesh.masses[j * columns + i] = cell_mass * share_u * share_v;
      }
    }
  }
  return mesh;
}

int grid_node(const ClothGrid& grid, int i, int j) {
  const int column = i < 0 ? grid.nodes[0] + i : i;
  const int row = j < 0 ? grid.nodes[1] + j : j;
  if (column < 0 || column >= grid.nodes[0] || row < 0 || row >= grid.nodes[1]) {
    throw InvalidArgument("cloth grid: node (" + std::to_string(i) + ", " + std::to_string(j) +
                          ") is outside " + std::to_string(grid.nodes[0]) + " x " +
                          std::to_string(grid.nodes[1]) + " nodes");
  }
  return row * grid.nodes[0] + column;
}

}  // namespace weft
