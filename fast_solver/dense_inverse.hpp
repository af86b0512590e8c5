#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <weft/fast_solver/aligned_matrix.hpp>
#include <weft/fast_solver/sparse_cholesky.hpp>
#include <weft/fast_solver/sparse_matrix.hpp>
#include <weft/fast_solver/thread_team.hpp>
#include <weft/fast_solver/weighted_sums.hpp>

namespace weft::fast {

/// The inverse of a small symmetric matrix, all entries of it, in half precision: for corrections. Up to some hundred
/// unknowns it is multiplied by faster than a sparse factor is solved with, whose panels are a few numbers each and wait
/// for one another, and any number of threads can share it.
///
/// What moves a piece of cloth as a whole is apart: where nothing but its mass holds it, that would be far larger than
/// what springs do, and half precision would lose those.
class DenseInverse {
 public:
  DenseInverse() = default;

  [[nodiscard]] int size() const { return static_cast<int>(piece_of_.size()); }
  /// Columns of vectors: those behind the unknowns are zero.
  [[nodiscard]] int filled_size() const;
  [[nodiscard]] std::size_t num_bytes() const { return entries_.size() * sizeof(std::uint16_t); }

  /// result = A^-1 right. One call at a time.
  void multiply(const Fours& right, Fours& result, ThreadTeam& team);

 private:
  friend class DenseInverseMaker;
  /// Unknowns of one piece in a row.
  struct Run {
    int piece;
    int begin;
    int end;
  };
  void sum_pieces(const Fours& right);

  float scale_ = 1;  ///< of entries
  AlignedVector<std::uint16_t>
      entries_;                ///< kDenseRows rows after the other, each column by column
  std::vector<int> piece_of_;  ///< of each unknown
  std::vector<Run> runs_;
  std::vector<float> shares_;  ///< of each piece: what is left out of all its entries
  Fours sums_;                 ///< of each piece, of the right-hand side
};

/// Makes one in parts.
class DenseInverseMaker {
 public:
  /// factor: of matrix, of one unknown at least; both must outlive the maker.
  DenseInverseMaker(const SymmetricMatrix& matrix, SparseCholesky& factor);

  /// So many columns more. True if they were the last.
  bool add_columns(int count);
  /// After the last one. Nothing, if half precision is too little for this matrix.
  [[nodiscard]] std::optional<DenseInverse> take();

 private:
  void find_pieces();
  void find_runs();
  [[nodiscard]] bool is_exact_enough() const;

  const SymmetricMatrix& matrix_;
  SparseCholesky& factor_;
  int next_ = 0;
  Eigen::MatrixXf inverse_;  ///< filled up
  Matrix3X<float> right_;
  Matrix3X<float> solution_;
  DenseInverse result_;
};

}  // namespace weft::fast
