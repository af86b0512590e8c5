#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include <weft/fast_solver/sparse_matrix.hpp>

namespace weft::fast {

/// How few nodes speak for many: value of unknown i = sum of weights times values of coarse unknowns.
struct Interpolation {
  int num_coarse = 0;
  std::vector<int> starts;     ///< unknown i has entries starts[i] ... starts[i + 1] - 1
  std::vector<int> columns;    ///< coarse unknown of each entry
  std::vector<double> values;  ///< weight of each entry, > 0

  [[nodiscard]] int size() const { return static_cast<int>(starts.size()) - 1; }
};

/// For a matrix of springs and masses (negative beside the diagonal). Coarse are unknowns of which no
/// two are neighbours and one of which is a neighbour of every other unknown; in between, what is in
/// balance with its coarse neighbours where those are held (the direct interpolation of algebraic multigrid,
/// Ruge and Stueben 1987).
[[nodiscard]] Interpolation make_interpolation(const SymmetricMatrix& matrix);

/// P^T A P: the matrix between coarse unknowns.
[[nodiscard]] SymmetricMatrix coarse_matrix(const SymmetricMatrix& matrix,
                                            const Interpolation& interpolation);

/// From the coarse unknowns of the second to the unknowns of the first.
[[nodiscard]] Interpolation composed(const Interpolation& first, const Interpolation& second);

/// Adds rows of numbers, one row at a time.
class RowSum {
 public:
  explicit RowSum(int num_columns)
      : values_(static_cast<std::size_t>(num_columns), 0.0),
        is_used_(static_cast<std::size_t>(num_columns), 0) {}

  void add(int column, double value) {
    const auto c = static_cast<std::size_t>(column);
    if (is_used_[c] == 0) columns_.push_back(column);
    is_used_[c] = 1;
    values_[c] += value;
  }
  /// Calls take(column, value) in ascending order of columns, and starts anew.
  template <class Take>
  void flush(const Take& take) {
    std::sort(columns_.begin(), columns_.end());
    for (const int column : columns_) {
      const auto c = static_cast<std::size_t>(column);
      take(column, values_[c]);
      values_[c] = 0;
      is_used_[c] = 0;
    }
    columns_.clear();
  }

 private:
  std::vector<double> values_;
  std::vector<char> is_used_;
  std::vector<int> columns_;
};

/// coarse_matrix(), some rows at a time.
class CoarseMatrixMaker {
 public:
  /// The arguments must outlive this object.
  CoarseMatrixMaker(const SymmetricMatrix& matrix, const Interpolation& p);
  /// The next rows, as many as there are up to count. True if these were the last.
  bool add_rows(int count);
  /// After the last row.
  [[nodiscard]] SymmetricMatrix take() { return std::move(result_); }

 private:
  const SymmetricMatrix* matrix_;
  const Interpolation* p_;
  /// Of each coarse unknown, those that it has a part in: row by row of P^T (A P).
  std::vector<std::vector<std::pair<int, double>>> parts_;
  RowSum sum_;
  int next_ = 0;
  SymmetricMatrix result_;
};

}  // namespace weft::fast
