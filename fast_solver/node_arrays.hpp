#pragma once

#include <Eigen/Core>

#include <weft/custom_forces/core/types.hpp>

namespace weft::fast {

/// Nodes that are computed together. Arrays of nodes are filled up with zeros to a multiple of it.
inline constexpr int kNodeBlock = 16;

[[nodiscard]] constexpr int fill_up(int num_nodes) {
  return (num_nodes + kNodeBlock - 1) / kNodeBlock * kNodeBlock;
}

/// x, y and z of all nodes, one array after the other, fill_up(number of nodes) x 3: so that a vector
/// of the processor holds one component of several nodes.
template <class Scalar>
using NodeArrays = Eigen::Matrix<Scalar, Eigen::Dynamic, 3>;

/// xx, yy, zz, xy, yz, zx of a symmetric 3 x 3 matrix for each node, in arrays as well.
using BlockArrays = Eigen::Matrix<float, Eigen::Dynamic, 6>;

/// arrays = vectors, 3 x n, and zeros behind them.
template <class Scalar>
void to_arrays(ConstMatrix3XRef<Scalar> vectors, NodeArrays<Scalar>& arrays) {
  const Eigen::Index n = vectors.cols();
  Scalar* const x = arrays.data();
  Scalar* const y = x + arrays.rows();
  Scalar* const z = y + arrays.rows();
  for (Eigen::Index i = 0; i < n; ++i) {
    x[i] = vectors(0, i);
    y[i] = vectors(1, i);
    z[i] = vectors(2, i);
  }
  arrays.bottomRows(arrays.rows() - n).setZero();
}

/// vectors, 3 x n = the first n of arrays.
template <class Scalar>
void from_arrays(const NodeArrays<Scalar>& arrays, Matrix3XRef<Scalar> vectors) {
  const Scalar* const x = arrays.data();
  const Scalar* const y = x + arrays.rows();
  const Scalar* const z = y + arrays.rows();
  for (Eigen::Index i = 0; i < vectors.cols(); ++i) {
    vectors(0, i) = x[i];
    vectors(1, i) = y[i];
    vectors(2, i) = z[i];
  }
}

/// The vector of one node.
template <class Scalar>
[[nodiscard]] Vector3<Scalar> at_node(const NodeArrays<Scalar>& arrays, Eigen::Index node) {
  return {arrays(node, 0), arrays(node, 1), arrays(node, 2)};
}

}  // namespace weft::fast
