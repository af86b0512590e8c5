#pragma once

#include <weft/mesh/cloth_mesh.hpp>

namespace weft {

/// Every edge of the triangles once, first index < second index, in the order in which the triangles
/// name them. 2 x m.
[[nodiscard]] Edges edges_of_triangles(const Triangles& triangles);

/// Pairs of triangles with an edge in common, 4 x h: (i, j, k, l), where the triangle (i, j, k) has
/// the edge from i to j and (j, i, l) has it from j to i; k and l are the nodes opposite. In the
/// order in which the triangles name the edges.
/// Throws InvalidArgument, with the numbers of the triangles, for an edge of three or more triangles
/// and for two neighbors that do not turn the same way round.
[[nodiscard]] Hinges hinges_of_triangles(const Triangles& triangles);

/// Those of both ways in which the cells of a mesh are cut: of its triangles, then of its crossed triangles. Throws likewise.
[[nodiscard]] Hinges bending_hinges(const ClothMesh& mesh);

/// Whether every edge belongs to exactly two triangles that turn the same way round, and there is at
/// least one triangle.
[[nodiscard]] bool is_closed_surface(const Triangles& triangles);

/// Angle of every hinge in the given positions, in (-pi, pi] [rad]: 0 flat, positive where the front
/// is the convex side (docs/conventions.md). h.
[[nodiscard]] VectorX<double> hinge_angles(ConstMatrix3XRef<double> positions,
                                           const Hinges& hinges);

/// The nodes around a node in the order in which its triangles meet, counter-clockwise seen from the
/// front; empty for a node of no triangle, is_open for one on the rim.
struct Ring {
  std::vector<int> nodes;
  bool is_open = false;
};

/// Ring of each of the given nodes. Throws InvalidArgument for a node whose triangles do not make
/// one fan.
[[nodiscard]] std::vector<Ring> rings(const Triangles& triangles, const std::vector<int>& nodes);

}  // namespace weft
