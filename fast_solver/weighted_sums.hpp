#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include <weft/fast_solver/aligned_matrix.hpp>

namespace weft::fast {

/// Vectors of x, y, z and a number that is not used: what a processor loads and adds at once.
using Fours = AlignedMatrix<float, 4, Eigen::Dynamic>;

/// A sparse matrix that is multiplied by vectors, its rows in parts for threads. In a part rows of equally many terms
/// follow each other, so that the processor foresees where each ends.
class WeightedSums {
 public:
  using Row = std::vector<std::pair<int, float>>;  ///< columns and weights

  WeightedSums() = default;
  /// ends: of each part, the row behind its last one; ascending.
  WeightedSums(const std::vector<Row>& rows, const std::vector<int>& ends);

  [[nodiscard]] int num_parts() const { return static_cast<int>(first_runs_.size()) - 1; }
  /// result = matrix values, the rows of a part.
  void multiply(int part, const Fours& values, Fours& result) const;

  /// Terms that come later, of any row.
  void add_term(int row, int column, float weight) { late_terms_.push_back({row, column, weight}); }
  /// result += what they make of values, in all rows.
  void add_late_terms(const Fours& values, Fours& result) const;

  /// take(column, weight) for each term of a row, those that came later too.
  template <class Take>
  void for_each_term(int row, const Take& take) const {
    if (static_cast<std::size_t>(row) < places_.size()) {
      const auto [first, count] = places_[static_cast<std::size_t>(row)];
      for (std::size_t k = first; k < first + count; ++k) take(columns_[k], weights_[k]);
    }
    for (std::size_t t = 0, end = late_terms_.size(); t < end; ++t) {
      const LateTerm term = late_terms_[t];
      if (term.row == row) take(term.column, term.weight);
    }
  }

  [[nodiscard]] std::size_t num_bytes() const;

 private:
  /// Rows of equally many terms.
  struct Run {
    std::size_t first_term;
    std::size_t first_row;  ///< in rows_
    long num_rows;
    long num_terms;
  };
  struct LateTerm {
    int row;
    int column;
    float weight;
  };

  std::vector<int> rows_;  ///< in the order of terms
  std::vector<int> columns_;
  std::vector<float> weights_;
  std::vector<Run> runs_;
  std::vector<std::size_t> first_runs_ = {0};                ///< of each part, and behind the last
  std::vector<std::pair<std::size_t, std::size_t>> places_;  ///< of each row: first term, number
  std::vector<LateTerm> late_terms_;
};

}  // namespace weft::fast
