#pragma once

#include <utility>
#include <vector>

#include <weft/fast_solver/coarse_nodes.hpp>
#include <weft/fast_solver/node_arrays.hpp>
#include <weft/fast_solver/sparse_cholesky.hpp>

namespace weft::fast {

/// What carries a corner's load through the whole cloth at once: the solution of a network that resists
/// equally in all directions, on few of its nodes, interpolated to the others. Details are for a smoother;
/// with one, few nodes correct as well as all of them do (docs/fast_solver.md).
/// Threads  one object from one thread at a time. Allocates nothing after construction.
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
  [[nodiscard]] int size() const { return factor_.size(); }
  /// Memory that solve() reads [bytes].
  [[nodiscard]] std::size_t num_bytes() const;

  /// correction = P (P^T A P)^-1 P^T residual; 0 at nodes that are not unknowns.
  void solve(const NodeArrays<float>& residual, NodeArrays<float>& correction);

 private:
  using Fours = Eigen::Matrix<float, 4, Eigen::Dynamic>;
  /// Weighted sums, all of equally many terms, so that the processor foresees where each ends. A few may be much
  /// longer, as that of a node to which all others are tied: the rest of their terms stands apart.
  struct Sums {
    struct Term {
      int sum;
      int column;
      float weight;
    };
    int num_terms = 0;
    std::vector<int> columns;  ///< num_terms for each sum
    std::vector<float> weights;
    std::vector<Term> rest;
  };
  [[nodiscard]] static Sums make_sums(const std::vector<std::vector<std::pair<int, float>>>& rows);
  static void add_up(const Sums& sums, const Fours& values, Fours& results);

  friend class CorrectionMaker;
  GlobalCorrection() = default;

  Sums coarsen_;  ///< P^T: of each coarse unknown, nodes
  Sums refine_;   ///< P: of each node, coarse unknowns
  SparseCholesky factor_;
  int num_nodes_ = 0;
  Matrix3X<float> right_;
  Matrix3X<float> solution_;
  Fours nodes_;  ///< filled up
  Fours coarse_;
  Fours coarse_sums_;
};

}  // namespace weft::fast
