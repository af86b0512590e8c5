#pragma once

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

}  // namespace weft::fast
