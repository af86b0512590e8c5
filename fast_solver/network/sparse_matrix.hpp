#pragma once

// Tested by tests/fast_solver/coarse/dissected_cholesky_test.cpp, tests/fast_solver/network/rest_stiffness_test.cpp.

#include <cstddef>
#include <vector>

namespace weft::fast {

/// A sparse symmetric matrix, compressed by rows: both (i, j) and (j, i) are stored, the diagonal apart.
struct SymmetricMatrix {
  std::vector<int> starts;       ///< row i has entries starts[i] ... starts[i + 1] - 1
  std::vector<int> columns;      ///< for each entry, never the row itself
  std::vector<double> values;    ///< for each entry
  std::vector<double> diagonal;  ///< for each row

  [[nodiscard]] int size() const { return static_cast<int>(diagonal.size()); }
};

/// An entry of a sum that makes a matrix: (row, column) and, if they differ, (column, row) as well.
struct MatrixPart {
  int row;
  int column;
  double value;
};

}  // namespace weft::fast
