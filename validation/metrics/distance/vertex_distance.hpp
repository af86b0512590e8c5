#pragma once

#include <optional>

#include <weft/core/types.hpp>
#include <weft/mesh/cloth_mesh.hpp>

namespace weft::validation {

/// How far two states of one mesh are apart, node by node.
struct VertexDistance {
  double rms = 0.0;      ///< sqrt(sum w_i |a_i - b_i|^2 / sum w_i) [m]
  double largest = 0.0;  ///< max |a_i - b_i| [m], whatever the weight
  int largest_node = 0;  ///< where that is; the first one if several are equal
  /// Set: a position is not finite there; rms and largest are NaN and largest_node is this node.
  std::optional<int> first_non_finite_node;

  /// rms as a fraction of a stated length > 0 [m], usually the size of the cloth [-]. Throws
  /// InvalidArgument.
  [[nodiscard]] double rms_relative_to(double length) const;
};

/// Weight of each node in an rms: its share of the rest area, sum 1. n [-].
/// A mesh without area (no triangles, or only degenerate ones) gives all nodes the same weight.
[[nodiscard]] VectorX<double> node_weights(const ClothMesh& mesh);

/// |a_i - b_i| of every node. n [m]; NaN where a position is not finite.
/// Shapes   a, b 3 x n [m], n >= 1
/// Errors   InvalidArgument for different or empty shapes
[[nodiscard]] VectorX<double> node_distances(ConstMatrix3XRef<double> a,
                                             ConstMatrix3XRef<double> b);

/// Distance as the states are.
/// Shapes   a, b 3 x n [m]; weights n, >= 0, not all zero (any unit)
/// Errors   InvalidArgument for shapes that do not fit and for weights out of their domain
[[nodiscard]] VertexDistance vertex_distance(ConstMatrix3XRef<double> a, ConstMatrix3XRef<double> b,
                                             const VectorX<double>& weights);

/// A proper rotation and a translation: x -> rotation x + translation.
struct RigidMotion {
  Matrix3<double> rotation = Matrix3<double>::Identity();
  Vector3<double> translation{0, 0, 0};  ///< [m]
  [[nodiscard]] Matrix3X<double> apply(ConstMatrix3XRef<double> positions) const;
};

/// The rigid motion of moving that makes the weighted rms distance to target smallest (Kabsch).
/// Never a reflection. For a line or a point, whose best rotation is not unique, one of the best
/// ones. All NaN for non-finite input. Shapes and errors as vertex_distance.
[[nodiscard]] RigidMotion best_rigid_motion(ConstMatrix3XRef<double> moving,
                                            ConstMatrix3XRef<double> target,
                                            const VectorX<double>& weights);

/// Distance of the shapes: after a has been moved onto b by best_rigid_motion.
[[nodiscard]] VertexDistance aligned_vertex_distance(ConstMatrix3XRef<double> a,
                                                     ConstMatrix3XRef<double> b,
                                                     const VectorX<double>& weights);

}  // namespace weft::validation
