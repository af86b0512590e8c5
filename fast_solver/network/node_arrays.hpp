#pragma once

// Tested by tests/fast_solver/network/spring_network_test.cpp, tests/fast_solver/network/edge_slots_test.cpp.

#include <algorithm>

#include <Eigen/Core>

#include <weft/core/types.hpp>
#include <weft/fast_solver/network/network_kernel.hpp>
#include <weft/fast_solver/simd/aligned_matrix.hpp>

namespace weft::fast {

/// Nodes that are computed together.
inline constexpr int kNodeBlock = 16;
/// Arrays of nodes are padded with zeros to a multiple of it: a thread's nodes begin with a line of the cache in all
/// of them, and in the one before there is nothing of it.
inline constexpr int kNodesPerCacheLine = 64;

[[nodiscard]] constexpr int padded_size(int num_nodes) {
  return (num_nodes + kNodesPerCacheLine - 1) / kNodesPerCacheLine * kNodesPerCacheLine;
}

/// Fewer nodes are one part (NodePartition), which no threads share.
inline constexpr int kFewestToShare = 15 * kNodesPerCacheLine;

/// Rows of arrays of nodes. Behind those that threads share is a gap: a processor fetches ahead of a loop, beyond its end
/// too, and there the next array begins, with nodes of another thread, which would have to get its lines back each time.
[[nodiscard]] constexpr int rows_for(int num_nodes) {
  constexpr int kGap = 2 * kNodesPerCacheLine;
  return padded_size(num_nodes) + (padded_size(num_nodes) < kFewestToShare ? 0 : kGap);
}

/// x, y and z of all nodes, one array after the other, rows_for(number of nodes) x 3: so that a vector
/// of the processor holds one component of several nodes.
template <class Scalar>
using NodeArrays = AlignedMatrix<Scalar, Eigen::Dynamic, 3>;

/// xx, yy, zz, xy, yz, zx of a symmetric 3 x 3 matrix for each node, in arrays as well.
using BlockArrays = AlignedMatrix<float, Eigen::Dynamic, 6>;

/// arrays = vectors, 3 x n, and zeros behind them; of some nodes.
template <class Scalar>
void to_arrays(ConstMatrix3XRef<Scalar> vectors, NodeRange nodes, NodeArrays<Scalar>& arrays) {
  const Eigen::Index end = std::min<Eigen::Index>(nodes.end, vectors.cols());
  Scalar* const x = arrays.data();
  Scalar* const y = x + arrays.rows();
  Scalar* const z = y + arrays.rows();
  for (Eigen::Index i = nodes.begin; i < end; ++i) {
    x[i] = vectors(0, i);
    y[i] = vectors(1, i);
    z[i] = vectors(2, i);
  }
  if (end < nodes.end) arrays.middleRows(end, nodes.end - end).setZero();
}

/// vectors, 3 x n = the first n of arrays, of some nodes.
template <class Scalar>
void from_arrays(const NodeArrays<Scalar>& arrays, NodeRange nodes, Matrix3XRef<Scalar> vectors) {
  const Eigen::Index end = std::min<Eigen::Index>(nodes.end, vectors.cols());
  const Scalar* const x = arrays.data();
  const Scalar* const y = x + arrays.rows();
  const Scalar* const z = y + arrays.rows();
  for (Eigen::Index i = nodes.begin; i < end; ++i) {
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
