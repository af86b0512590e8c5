#include <weft/reference/statics/definite_factor.hpp>

namespace weft::reference {

void DefiniteFactor::factorize(const Eigen::SparseMatrix<double>& matrix) {
  if (!is_analyzed_) factor_.analyzePattern(matrix);
  is_analyzed_ = true;
  const double scale = matrix.diagonal().cwiseAbs().mean();
  Eigen::SparseMatrix<double> identity(matrix.rows(), matrix.cols());
  identity.setIdentity();
  constexpr double kFirstShift = 1e-9;  // of the mean diagonal: far below any mode that matters
  constexpr int kMaxShifts = 12;
  double shift = 0.0;
  for (int attempt = 0; attempt <= kMaxShifts; ++attempt) {
    factor_.factorize(shift > 0.0 ? Eigen::SparseMatrix<double>(matrix + shift * identity)
                                  : matrix);
    if (factor_.info() == Eigen::Success && factor_.vectorD().minCoeff() > 0.0) return;
    shift = shift > 0.0 ? 10 * shift : kFirstShift * scale;
  }
}

Eigen::VectorXd DefiniteFactor::solve(const Eigen::VectorXd& right) const {
  return factor_.solve(right);
}

}  // namespace weft::reference
