#pragma once

#include <memory>
#include <string>
#include <vector>

#include <weft/custom_forces/registry.hpp>

namespace weft::forces {

/// Rounding errors of the few operations behind one hand-computed value [-].
inline constexpr double kRoundings = 16.0;
inline constexpr double kRoundoff = kRoundings * 2.220446049250313e-16;

/// Nodes at the given positions [m] with mass 1 kg each, and one edge set "spring".
inline ClothMesh small_mesh(const Matrix3X<double>& rest_positions, const Edges& edges) {
  ClothMesh mesh;
  mesh.rest_positions = rest_positions;
  mesh.triangles.resize(3, 0);
  mesh.edge_sets.push_back({"spring", edges});
  mesh.masses = VectorX<double>::Ones(rest_positions.cols());
  return mesh;
}

/// Two nodes on the x axis, rest_length [m] apart, one edge.
inline ClothMesh one_spring(double rest_length) {
  Matrix3X<double> positions = Matrix3X<double>::Zero(3, 2);
  positions(0, 1) = rest_length;
  return small_mesh(positions, Edges{{0}, {1}});
}

/// Forces [N] of one law on a mesh, 3 x n.
inline Matrix3X<double> forces_on(const LawSpecification& specification, const ClothMesh& mesh,
                                  const Matrix3X<double>& positions,
                                  const Matrix3X<double>& velocities) {
  const auto law = make_law<double>(specification, mesh);
  Matrix3X<double> scratch(3, law->scratch_columns());
  Matrix3X<double> forces = Matrix3X<double>::Zero(3, positions.cols());
  law->add_forces({positions, velocities, mesh.masses}, scratch, forces);
  return forces;
}

}  // namespace weft::forces
