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

  /// A row behind the others, of which no part knows.
  void append(Row row) { appended_.push_back(std::move(row)); }
  [[nodiscard]] int num_rows() const { return static_cast<int>(places_.size() + appended_.size()); }
  /// result = matrix values, the rows that were appended.
  void multiply_appended(const Fours& values, Fours& result) const;
  /// One more term of one of the first rows.
  void add_term(int row, int column, float weight) { late_terms_.push_back({row, column, weight}); }
  /// result += what such terms make of values.
  void add_late_terms(const Fours& values, Fours& result) const;

  /// take(column, weight) for each term of a row, but for those of add_term().
  template <class Take>
  void for_each_term(int row, const Take& take) const {
    const auto r = static_cast<std::size_t>(row);
    if (r < places_.size()) {
      const auto [first, count] = places_[r];
      for (std::size_t k = first; k < first + count; ++k) take(columns_[k], weights_[k]);
    } else {
      for (const auto& [column, weight] : appended_[r - places_.size()]) take(column, weight);
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
  std::vector<Row> appended_;
  std::vector<LateTerm> late_terms_;
};

}  // namespace weft::fast
