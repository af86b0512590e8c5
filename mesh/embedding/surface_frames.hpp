#pragma once

// Tested by tests/mesh/embedding/cloth_embedding_test.cpp.

#include <vector>

#include <weft/core/types.hpp>

namespace weft {

/// How a cloth is deformed around each of its nodes: the mean, by rest area, of the deformation gradients of the triangles around
/// the node. A triangle's gradient takes its rest edges to its edges and its unit normal to its unit normal.
class SurfaceFrames {
 public:
  /// Every triangle must have an area at rest.
  SurfaceFrames(ConstMatrix3XRef<double> rest_positions, const Triangles& triangles);

  /// The same triangles of a cloth that has torn, with more nodes; rest areas and edges stay theirs.
  void change_nodes(const Triangles& triangles, int num_nodes);

  [[nodiscard]] int num_nodes() const { return static_cast<int>(inverse_areas_.size()); }
  [[nodiscard]] const Triangles& triangles() const { return triangles_; }

  /// Gradients [-] of all nodes, 3 x 3n, node i in columns 3i to 3i + 2; a node without a triangle has zeros. The identity at rest,
  /// the rotation of a cloth that moves as a rigid body. positions: 3 x n [m]. frames must have its size: nothing is allocated.
  void compute(ConstMatrix3XRef<double> positions, Matrix3XRef<double> frames) const;

 private:
  Triangles triangles_;
  Matrix3X<double>
      inverses_;           ///< of the rest edges and normal of each triangle, 3 x 3t [1/m, 1/m, -]
  VectorX<double> areas_;  ///< of triangles at rest [m^2]
  VectorX<double> inverse_areas_;  ///< of the triangles around each node [1/m^2]; 0: none
};

}  // namespace weft
