#pragma once

// Tested by tests/mesh/cloth_grid_test.cpp, tests/mesh/cutting/tear_test.cpp.

#include <string>
#include <string_view>
#include <vector>

#include <weft/core/types.hpp>

namespace weft {

/// A named set of edges, so that a law can act on some springs and not on others ("stretch",
/// "shear", "bend").
struct EdgeSet {
  std::string name;
  Edges edges;  ///< 2 x m, first index < second index, no duplicates
};

/// A named set of node triples in a row, for three-point torsion.
struct LineSet {
  std::string name;
  Triples triples;  ///< 3 x m: end, centre, end
};

/// A named set of connections between nodes that are not neighbors.
struct ConnectionSet {
  std::string name;
  Edges connections;  ///< 2 x m: the node whose frame counts, the far node
};

/// A named region of the mesh, so that a law can act on some nodes and not on others.
struct NodeSet {
  std::string name;
  std::vector<int> nodes;  ///< sorted
};

/// How the total mass is shared out.
enum class MassLumping {
  kArea,  ///< by rest area (a rope: by length): an edge node of a grid has half of an inner node's
          ///< mass, a corner node a quarter
  kUniform,  ///< the same mass for every node
};

/// One piece of cloth as every engine receives it: rest shape, topology and mass. Knows no engine.
struct ClothMesh {
  Matrix3X<double> rest_positions;  ///< 3 x n [m]; rest lengths and angles come from here
  Triangles triangles;              ///< 3 x t, counter-clockwise seen from the front
  /// The same surface with its four-sided cells cut along their other diagonals, 3 x t; empty for a
  /// surface that has no such cells. Only bending looks at it: one way of cutting alone would make a
  /// sheet whose nodes give way by turns (hinge_torsion.hpp).
  Triangles crossed_triangles = Triangles(3, 0);
  std::vector<EdgeSet> edge_sets;
  std::vector<LineSet> line_sets = {};
  std::vector<ConnectionSet> connection_sets = {};
  std::vector<NodeSet> node_sets = {};
  VectorX<double> masses;   ///< n [kg], > 0 for every node, also for pinned ones
  std::vector<int> pinned;  ///< sorted node indices that no force moves
  /// Velocities of the pinned nodes, 3 x pinned.size() [m/s]: they keep moving so. Empty: they stand still.
  Matrix3X<double> pinned_velocities = {};
  /// Place of each node in a picture, 2 x n [-]: (0, 0) is its lower left, (1, 1) its upper right
  /// corner, and the picture repeats beyond. Empty: none.
  Matrix2X<double> texture_coordinates = {};
  /// The same for each corner of each triangle, 2 x 3t, corner c of triangle t in column 3t + c: for
  /// surfaces with a seam, where one node has several places. If there, it takes precedence.
  Matrix2X<double> corner_texture_coordinates = {};

  [[nodiscard]] int num_nodes() const { return static_cast<int>(rest_positions.cols()); }
  [[nodiscard]] int num_edges() const;
  [[nodiscard]] bool has_edge_set(std::string_view name) const;
  /// Velocity of the i-th pinned node [m/s].
  [[nodiscard]] Vector3<double> pinned_velocity(std::size_t i) const;
  /// The edges of the named sets, one after the other. Throws InvalidArgument for an unknown set.
  [[nodiscard]] Edges edges_of(const std::vector<std::string>& set_names) const;
};

/// Throws InvalidArgument, which names the place and what was expected there, for a mesh that does not fit
/// together: no node, masses, velocities or places that are too many, too few or not finite, a mass that is
/// not > 0, and indices of nodes out of range (triangles, edges, lines, connections, regions, pins).
void check_mesh(const ClothMesh& mesh);

/// Adds connections from one node to each of the far nodes, as a connection set of this name. Throws
/// InvalidArgument for a node outside the mesh, a far node that is the node itself, and a name that
/// is taken.
void connect(ClothMesh& mesh, const std::string& name, int node, const std::vector<int>& far_nodes);

/// Place of each corner of each triangle in a picture, 2 x 3t, from whichever of the two the mesh
/// has; empty if it has none. Throws InvalidArgument if their numbers do not fit the mesh.
[[nodiscard]] Matrix2X<double> corner_coordinates(const ClothMesh& mesh);

/// Rest area that belongs to each node: a third of each triangle around it. n [m^2].
[[nodiscard]] VectorX<double> node_areas(const ClothMesh& mesh);

/// Length of each edge in the given positions. m [m].
[[nodiscard]] VectorX<double> edge_lengths(ConstMatrix3XRef<double> positions, const Edges& edges);

}  // namespace weft
