#pragma once

#include <cstddef>
#include <vector>

#include <weft/custom_forces/core/types.hpp>
#include <weft/fast_solver/aligned_matrix.hpp>
#include <weft/fast_solver/elimination.hpp>
#include <weft/fast_solver/sparse_matrix.hpp>
#include <weft/fast_solver/thread_team.hpp>

namespace weft::fast {

/// The Cholesky factor of a sparse symmetric positive definite matrix, kept in single precision, made to be
/// applied to three right-hand sides again and again.
///
/// Every supernode is one dense panel G = [L11^-1; L21 L11^-1], so that both passes are products of
/// panels with vectors. A supernode hands its part to its parent in a vector of its own, as in a
/// multifrontal factorisation: sums have one order, and subtrees run in parallel with the same bits.
/// Threads  solve() of one object from one thread at a time, for it works in memory of the object, and on a team.
///          Allocates nothing.
class SparseCholesky {
 public:
  SparseCholesky() = default;
  /// order: an elimination order (minimum_degree_order()). names: what solve() calls the unknowns, the
  /// columns of its arguments; empty: their own numbers. Throws InvalidArgument for a matrix that is not positive definite.
  SparseCholesky(const SymmetricMatrix& matrix, const std::vector<int>& order,
                 const std::vector<int>& names = {});

  /// The same, in two parts that take about as long.
  SparseCholesky(const SymmetricMatrix& matrix, Elimination elimination,
                 const std::vector<int>& names = {});

  [[nodiscard]] int size() const { return static_cast<int>(elimination_.order.size()); }
  /// Entries of the factor, of which stored zeros are counted too.
  [[nodiscard]] std::size_t num_entries() const { return num_entries_; }
  /// Memory that a solve reads [bytes].
  [[nodiscard]] std::size_t num_bytes() const;

  /// result = A^-1 right, both 3 x the number of names. Columns that no unknown has are left alone.
  void solve(ConstMatrix3XRef<float> right, Matrix3XRef<float> result, ThreadTeam& team);

 private:
  /// Places of a supernode's parts in the arrays.
  struct Front {
    std::size_t panel = 0;   ///< first entry in panels_
    std::size_t vector = 0;  ///< first entry in vectors_; three arrays of num_rows
    std::size_t into_parent =
        0;             ///< first of into_parent_: where the parent keeps each of its rows
    int num_rows = 0;  ///< columns and rows below, filled up to blocks
    int num_below = 0;
    int first_child = 0;  ///< of children_
    int num_children = 0;
  };
  struct Range {
    int begin;
    int end;
  };

  void lay_out();
  void divide_work();
  void factorize(const SymmetricMatrix& matrix);
  void go_up(int s, ConstMatrix3XRef<float> right, float* scratch);
  void go_down(int s, Matrix3XRef<float> result, float* scratch);

  Elimination elimination_;
  std::vector<int> names_;  ///< column of the k-th unknown in solve()
  std::vector<Front> fronts_;
  std::vector<int> children_;
  std::vector<int> into_parent_;
  std::vector<Range> subtrees_;  ///< supernodes that depend on nothing outside, one task each
  std::vector<int> top_;         ///< the others
  AlignedVector<float> panels_;
  AlignedVector<float> vectors_;
  AlignedVector<float> scratch_;  ///< one vector per subtree and one for the top
  std::size_t scratch_stride_ = 0;
  std::size_t num_entries_ = 0;
};

}  // namespace weft::fast
