#pragma once

#include <vector>

#include <weft/mesh/cloth_mesh.hpp>

namespace weft {

class Neighborhood;

/// A mesh after a cut, and where its new nodes come from.
struct Tear {
  ClothMesh mesh;
  /// For each node that was added, in order: the node before the cut whose place and velocity it has.
  /// Nodes that were there keep their numbers. Empty: nothing has come apart.
  std::vector<int> origins;
  /// The nodes, ascending, of every triangle, crossed triangle, edge and line that has come, has gone or
  /// has another node than before: what depends on elements of other nodes only is as it was.
  std::vector<int> changed = {};

  [[nodiscard]] bool any() const { return !origins.empty(); }
};

/// Cuts a mesh along edges of its triangles.
///
/// The triangles around a node hang together where two of them share an edge that is not cut. A
/// node whose triangles fall into several fans becomes one node per fan: the fan with the
/// triangle of the lowest number keeps the old node. So a single edge inside the cloth stays shut,
/// two in a row open at the node between them, and no node holds two fans together (bow tie). No
/// triangle is lost; one that is cut all around is a piece of its own.
///
/// What follows, from rest_positions alone and never from a deformed shape:
/// * masses are shared by the fans' rest areas, rounded so that the copies' masses sum to the node's
///   exactly, in any order, also after they were split again;
/// * a spring of an edge set stays with the nodes that its straight line at rest still joins through
///   triangles on one side of the cut. It vanishes where the cut crosses the line. Where the cut
///   runs along it, each side has it, like any rim of a grid. So at equal positions the springs'
///   energy falls by that of the springs crossed and rises by that of the springs along the cut;
/// * lines are dealt with alike; crossed triangles stay for cells whose own diagonal is whole;
/// * a connection holds as long as both nodes belong to one piece, and stays with the old nodes;
/// * copies of a pinned node are pinned and move alike; copies join the node sets of their origin.
///
/// Throws InvalidArgument for a node that the mesh does not have and for an edge of more than two
/// triangles. Edges that no two triangles share are no cuts.
[[nodiscard]] Tear cut_along(const ClothMesh& mesh, const Edges& cut);
/// The same for who knows what is next to what already: near is of this mesh.
[[nodiscard]] Tear cut_along(const ClothMesh& mesh, const Neighborhood& near, const Edges& cut);

}  // namespace weft
