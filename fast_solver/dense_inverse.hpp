#pragma once

#include <cstddef>
#include <cstdint>

#include <weft/fast_solver/aligned_matrix.hpp>
#include <weft/fast_solver/sparse_cholesky.hpp>
#include <weft/fast_solver/thread_team.hpp>
#include <weft/fast_solver/weighted_sums.hpp>

namespace weft::fast {

/// The inverse of a small symmetric matrix, all entries of it, in half precision: for corrections. Up to some hundred
/// unknowns it is multiplied by faster than a sparse factor is solved with, whose panels are a few numbers each and wait
/// for one another, and any number of threads can share it.
class DenseInverse {
 public:
  DenseInverse() = default;
  explicit DenseInverse(SparseCholesky& factor);

  [[nodiscard]] int size() const { return size_; }
  /// Columns of vectors: those behind the unknowns are zero.
  [[nodiscard]] int filled_size() const;
  [[nodiscard]] std::size_t num_bytes() const { return entries_.size() * sizeof(std::uint16_t); }

  /// result = A^-1 right
  void multiply(const Fours& right, Fours& result, ThreadTeam& team) const;

 private:
  int size_ = 0;
  float scale_ = 1;  ///< of entries
  AlignedVector<std::uint16_t>
      entries_;  ///< kDenseRows rows after the other, each column by column
};

}  // namespace weft::fast
