#pragma once

// Tested by tests/fast_solver/coarse/coarse_correction_test.cpp.

#include <algorithm>
#include <cstddef>
#include <vector>

namespace weft::fast {

/// The prolongation matrix in compressed rows: unknown i = sum of weights times coarse coefficients.
struct Prolongation {
  int num_coarse = 0;
  std::vector<int> starts;     ///< unknown i has entries starts[i] ... starts[i + 1] - 1
  std::vector<int> columns;    ///< coarse unknown of each entry
  std::vector<double> values;  ///< weight of each entry, > 0

  [[nodiscard]] int size() const { return static_cast<int>(starts.size()) - 1; }
};

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

}  // namespace weft::fast
