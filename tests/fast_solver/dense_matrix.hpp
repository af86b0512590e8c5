#pragma once

#include <cstddef>

#include <Eigen/Core>

#include <weft/fast_solver/network/sparse_matrix.hpp>

namespace weft::fast {

/// All entries of the matrix.
inline Eigen::MatrixXd dense(const SymmetricMatrix& a) {
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(a.size(), a.size());
  for (int i = 0; i < a.size(); ++i) {
    const auto row = static_cast<std::size_t>(i);
    result(i, i) = a.diagonal[row];
    for (int e = a.starts[row]; e < a.starts[row + 1]; ++e) {
      result(i, a.columns[static_cast<std::size_t>(e)]) = a.values[static_cast<std::size_t>(e)];
    }
  }
  return result;
}

}  // namespace weft::fast
