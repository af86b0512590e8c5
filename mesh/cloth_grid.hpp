#pragma once

#include <array>
#include <string>
#include <vector>

#include <weft/mesh/cloth_mesh.hpp>

namespace weft {

/// Which nodes a grid node is tied to.
enum class GridStencil {
  k24Neighbour,  ///< every node of the 5 x 5 block around it: the cloth of de Joya 2011
  k12Neighbour,  ///< 4 structural, 4 diagonal, 4 skip-one springs
  k8Neighbour,   ///< 4 structural, 4 diagonal springs; no "bend" set
};

/// A rectangular cloth, nodes[0] x nodes[1] nodes, lying in the plane of u_axis and v_axis around
/// center. Node (i, j) has index j * nodes[0] + i and stands at
///   center + (i / (nodes[0] - 1) - 1/2) size[0] u + (j / (nodes[1] - 1) - 1/2) size[1] v.
struct ClothGrid {
  std::array<int, 2> nodes{2, 2};        ///< >= 2 each
  std::array<double, 2> size{1.0, 1.0};  ///< [m], > 0
  Vector3<double> center{0, 0, 0};       ///< [m]
  Vector3<double> u_axis{1, 0, 0};       ///< direction [-], normalised on use
  /// Direction [-], perpendicular to u_axis; the front normal is u x v.
  Vector3<double> v_axis{0, 0, -1};
  GridStencil stencil = GridStencil::k24Neighbour;
  double total_mass = 1.0;  ///< [kg], > 0
  MassLumping lumping = MassLumping::kArea;
};

/// One edge set of a grid: each node (i, j) is joined to the nodes (i + step[0], j + step[1]), as far as
/// the grid has them.
struct GridEdgeSet {
  std::string name;
  /// One of each pair of opposite steps, with a positive step of the index, so that every spring
  /// appears once and its first node has the lower index.
  std::vector<std::array<int, 2>> steps;
};

/// The edge sets that make_cloth_grid() gives a grid with this stencil, in their order.
[[nodiscard]] std::vector<GridEdgeSet> grid_edge_sets(GridStencil stencil);

/// Builds the mesh: edge sets "stretch" (distance 1), "shear" (diagonals) and "bend" (ring 2), line
/// sets "lines_u" and "lines_v" (three next neighbors along an axis), and union-jack triangles (the
/// diagonal alternates, so that no direction is preferred) with their crossed ones. The texture
/// coordinates of node (i, j) are (i / (nodes[0] - 1), j / (nodes[1] - 1)). Throws InvalidArgument for
/// sizes out of their domain and for axes that are not perpendicular.
[[nodiscard]] ClothMesh make_cloth_grid(const ClothGrid& grid);

/// Index of node (i, j); negative values count from the far side, so (-1, -1) is the last node.
/// Throws InvalidArgument for a node outside the grid.
[[nodiscard]] int grid_node(const ClothGrid& grid, int i, int j);

}  // namespace weft
