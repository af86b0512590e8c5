#pragma once

// Tested by tests/reference/statics/static_solver_test.cpp.

#include <weft/core/eigen_alignment.hpp>

#include <Eigen/SparseCholesky>

namespace weft::reference {

/// Sparse Cholesky factor of a symmetric matrix, of which a multiple of the identity is added until
/// it is positive definite: what is solved with it goes downhill. The pattern is analysed once.
class DefiniteFactor {
 public:
  /// matrix: always with the same pattern.
  void factorize(const Eigen::SparseMatrix<double>& matrix);
  [[nodiscard]] Eigen::VectorXd solve(const Eigen::VectorXd& right) const;

 private:
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor_;
  bool is_analyzed_ = false;
};

}  // namespace weft::reference
