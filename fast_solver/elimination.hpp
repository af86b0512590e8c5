#pragma once

#include <vector>

#include <weft/fast_solver/sparse_matrix.hpp>

namespace weft::fast {

/// Columns of a Cholesky factor with the same rows below them, in a row: a dense trapezoid.
struct Supernode {
  int first = 0;          ///< first column (elimination order)
  int width = 0;          ///< number of columns
  std::vector<int> rows;  ///< below the columns, ascending (elimination order)
  int parent = -1;        ///< the supernode of rows.front(); -1 for a root
};

/// What a Cholesky factor looks like before any number is known.
struct Elimination {
  std::vector<int> order;             ///< order[k]: unknown eliminated as the k-th
  std::vector<Supernode> supernodes;  ///< children before their parents
};

/// order is refined: children of the elimination tree come right before their parents, and supernodes
/// are merged with their parents where that stores few zeros.
[[nodiscard]] Elimination eliminate(const SymmetricMatrix& matrix, const std::vector<int>& order);

}  // namespace weft::fast
