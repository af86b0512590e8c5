#pragma once

#include <vector>

#include <weft/fast_solver/coarse_nodes.hpp>
#include <weft/fast_solver/dense_inverse.hpp>
#include <weft/fast_solver/node_arrays.hpp>
#include <weft/fast_solver/node_parts.hpp>
#include <weft/fast_solver/sparse_cholesky.hpp>
#include <weft/fast_solver/thread_team.hpp>
#include <weft/fast_solver/weighted_sums.hpp>

namespace weft::fast {

/// What carries a corner's load through the whole cloth at once: the solution of a network that resists
/// equally in all directions, on few of its nodes, interpolated to the others. Details are for a smoother;
/// with one, few nodes correct as well as all of them do (docs/fast_solver.md).
/// Threads  one object from one thread at a time, but for calls that say otherwise. Allocates nothing after construction.
class GlobalCorrection {
 public:
  /// matrix: of the unknowns, positive definite, negative beside the diagonal where springs are.
  /// names: the node of each unknown. Throws InvalidArgument for a matrix that is not positive definite.
  GlobalCorrection(const SymmetricMatrix& matrix, const std::vector<int>& names, int num_nodes);

  /// Nodes that come behind the others, copies of these: they have their origins' parts in the coarse
  /// unknowns from now on. That is no correction of a network that has come apart between them, but still
  /// a symmetric positive semidefinite one, and for a few nodes a good one.
  void add_copies(const std::vector<int>& origins);

  /// Coarse unknowns.
  [[nodiscard]] int size() const { return size_; }
  /// Memory that a correction reads [bytes].
  [[nodiscard]] std::size_t num_bytes() const;

  // correction = P (P^T A P)^-1 P^T residual, 0 at nodes that are not unknowns, in three parts:

  /// residual = a - b, of some nodes. Several calls may run at once.
  void set_residual(NodeRange nodes, const NodeArrays<float>& a, const NodeArrays<float>& b);
  /// For coarse unknowns, after the residual of all nodes.
  void solve(ThreadTeam& team);
  /// From coarse unknowns to the nodes of each of num_parts() parts. Several calls may run at once.
  void interpolate(int part, NodeArrays<float>& correction);
  [[nodiscard]] int num_parts() const { return parts_.count(); }
  [[nodiscard]] NodeRange nodes_of(int part) const;

 private:
  friend class CorrectionMaker;
  GlobalCorrection() = default;

  int size_ = 0;
  int num_nodes_ = 0;
  NodeParts parts_;
  WeightedSums coarsen_;   ///< P^T: of each coarse unknown, nodes
  WeightedSums refine_;    ///< P: of each node, coarse unknowns
  DenseInverse inverse_;   ///< of few unknowns
  SparseCholesky factor_;  ///< of more
  Matrix3X<float> right_;  ///< for the factor
  Matrix3X<float> solution_;
  Fours nodes_;        ///< filled up
  Fours coarse_;       ///< filled up
  Fours coarse_sums_;  ///< filled up
};

}  // namespace weft::fast
