#include <weft/fast_solver/weighted_sums.hpp>

#include <algorithm>
#include <numeric>

#include <weft/fast_solver/network_kernel.hpp>

namespace weft::fast {

WeightedSums::WeightedSums(const std::vector<Row>& rows, const std::vector<int>& ends)
    : places_(rows.size()) {
  std::size_t num_terms = 0;
  for (const Row& row : rows) num_terms += row.size();
  columns_.reserve(num_terms);
  weights_.reserve(num_terms);
  const auto size_of = [&](int row) { return rows[static_cast<std::size_t>(row)].size(); };
  int begin = 0;
  for (const int end : ends) {
    const std::size_t first = rows_.size();
    rows_.resize(first + static_cast<std::size_t>(end - begin));
    const auto part = rows_.begin() + static_cast<std::ptrdiff_t>(first);
    std::iota(part, rows_.end(), begin);
    std::stable_sort(part, rows_.end(), [&](int a, int b) { return size_of(a) < size_of(b); });
    for (std::size_t place = first; place < rows_.size(); ++place) {
      const Row& row = rows[static_cast<std::size_t>(rows_[place])];
      const auto size = static_cast<long>(row.size());
      if (place == first || runs_.back().num_terms != size) {
        runs_.push_back({columns_.size(), place, 0, size});
      }
      ++runs_.back().num_rows;
      places_[static_cast<std::size_t>(rows_[place])] = {columns_.size(), row.size()};
      for (const auto& [column, weight] : row) {
        columns_.push_back(column);
        weights_.push_back(weight);
      }
    }
    first_runs_.push_back(runs_.size());
    begin = end;
  }
}

void WeightedSums::multiply(int part, const Fours& values, Fours& result) const {
  const auto p = static_cast<std::size_t>(part);
  for (std::size_t r = first_runs_[p]; r < first_runs_[p + 1]; ++r) {
    const Run& run = runs_[r];
    vector_kernel().sum_terms({rows_.data() + run.first_row, run.num_rows, run.num_terms,
                               columns_.data() + run.first_term, weights_.data() + run.first_term},
                              values.data(), result.data());
  }
}

void WeightedSums::multiply_appended(const Fours& values, Fours& result) const {
  for (std::size_t r = 0; r < appended_.size(); ++r) {
    auto sum = result.col(static_cast<Eigen::Index>(places_.size() + r));
    sum.setZero();
    for (const auto& [column, weight] : appended_[r]) sum += weight * values.col(column);
  }
}

void WeightedSums::add_late_terms(const Fours& values, Fours& result) const {
  for (const LateTerm& term : late_terms_) {
    result.col(term.row) += term.weight * values.col(term.column);
  }
}

std::size_t WeightedSums::num_bytes() const {
  return columns_.size() * (sizeof(int) + sizeof(float)) + rows_.size() * sizeof(int);
}

}  // namespace weft::fast
