#pragma once

// Tested by tests/core/symmetric_matrix_test.cpp.

#include <weft/core/types.hpp>

namespace weft {

/// A symmetric matrix A = V diag(values) V^T.
struct SymmetricModes {
  VectorX<double> values;   ///< n eigenvalues, ascending
  Eigen::MatrixXd vectors;  ///< n x n, a column for each; orthonormal
};

/// Eigenvalues and eigenvectors of a symmetric matrix, n x n, of which the lower triangle is read
/// (Eigen::SelfAdjointEigenSolver, which every file that names it would compile anew).
[[nodiscard]] SymmetricModes symmetric_modes(const Eigen::MatrixXd& matrix);

/// x of matrix x = right for a symmetric matrix, n x n, that is positive or negative semidefinite; right is n x m (Eigen::LDLT).
[[nodiscard]] Eigen::MatrixXd solve_symmetric(const Eigen::MatrixXd& matrix,
                                              const Eigen::MatrixXd& right);

}  // namespace weft
