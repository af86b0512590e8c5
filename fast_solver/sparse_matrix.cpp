#include <weft/fast_solver/sparse_matrix.hpp>

#include <algorithm>

namespace weft::fast {

SymmetricMatrix sum_of_parts(int size, const std::vector<MatrixPart>& parts) {
  SymmetricMatrix matrix;
  const auto n = static_cast<std::size_t>(size);
  matrix.diagonal.assign(n, 0.0);
  std::vector<int> ends(n + 1, 0);
  const auto at = [](int i) { return static_cast<std::size_t>(i); };
  for (const MatrixPart& part : parts) {
    if (part.row == part.column) {
      matrix.diagonal[at(part.row)] += part.value;
    } else {
      ++ends[at(part.row) + 1];
      ++ends[at(part.column) + 1];
    }
  }
  for (std::size_t i = 0; i < n; ++i) ends[i + 1] += ends[i];
  std::vector<int> next(ends.begin(), ends.end() - 1);
  std::vector<std::pair<int, double>> entries(at(ends[n]));
  for (const MatrixPart& part : parts) {
    if (part.row == part.column) continue;
    entries[at(next[at(part.row)]++)] = {part.column, part.value};
    entries[at(next[at(part.column)]++)] = {part.row, part.value};
  }
  matrix.starts.assign(1, 0);
  for (std::size_t i = 0; i < n; ++i) {
    const auto begin = entries.begin() + ends[i];
    const auto end = entries.begin() + ends[i + 1];
    std::stable_sort(begin, end, [](const auto& a, const auto& b) { return a.first < b.first; });
    for (auto entry = begin; entry != end; ++entry) {
      if (entry != begin && matrix.columns.back() == entry->first) {
        matrix.values.back() += entry->second;
      } else {
        matrix.columns.push_back(entry->first);
        matrix.values.push_back(entry->second);
      }
    }
    matrix.starts.push_back(static_cast<int>(matrix.columns.size()));
  }
  return matrix;
}

}  // namespace weft::fast
