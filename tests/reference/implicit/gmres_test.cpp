#include <weft/reference/implicit/gmres.hpp>

#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/Dense>

namespace weft::reference {
namespace {

constexpr int kSize = 40;

/// Not symmetric, with eigenvalues around 1 and one far away.
Eigen::MatrixXd some_matrix() {
  Eigen::MatrixXd matrix(kSize, kSize);
  for (int i = 0; i < kSize; ++i) {
    for (int j = 0; j < kSize; ++j) matrix(i, j) = 0.1 * std::sin(1.0 + 7 * i + 3 * j * j);
    matrix(i, i) += i == 5 ? 400.0 : 2.0;
  }
  return matrix;
}

LinearMap product_with(const Eigen::MatrixXd& matrix) {
  return [&matrix](const VectorX<double>& vector, VectorX<double>& result) {
    result = matrix * vector;
  };
}

void copy(const VectorX<double>& vector, VectorX<double>& result) {
  result = vector;
}

TEST(Gmres, SolvesWhatIsNotSymmetricAndKnowsItsResidual) {
  const Eigen::MatrixXd matrix = some_matrix();
  const VectorX<double> right = VectorX<double>::LinSpaced(kSize, -1.0, 2.0);
  VectorX<double> solution;
  const KrylovOutcome outcome =
      gmres(product_with(matrix), copy, right, 1e-10, 2 * kSize, solution);
  EXPECT_LE(outcome.iterations, kSize);  // exact arithmetic needs no more than unknowns
  const double residual = (matrix * solution - right).norm() / right.norm();
  EXPECT_LE(residual, 1e-10);
  EXPECT_NEAR(outcome.residual, residual, 1e-13);
}

TEST(Gmres, WithTheInverseAsPreconditionerEndsAtOnce) {
  const Eigen::MatrixXd matrix = some_matrix();
  const Eigen::MatrixXd inverse = matrix.inverse();
  const VectorX<double> right = VectorX<double>::LinSpaced(kSize, -1.0, 2.0);
  VectorX<double> solution;
  const KrylovOutcome outcome =
      gmres(product_with(matrix), product_with(inverse), right, 1e-10, kSize, solution);
  EXPECT_EQ(outcome.iterations, 1);
  EXPECT_LE((matrix * solution - right).norm(), 1e-10 * right.norm());
}

TEST(Gmres, OfNothingIsNothingAndOfASingularMatrixIsFinite) {
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(kSize, kSize);
  VectorX<double> solution;
  EXPECT_EQ(gmres(product_with(matrix), copy, VectorX<double>::Zero(kSize), 1e-10, kSize, solution)
                .iterations,
            0);
  EXPECT_TRUE(solution.isZero(0.0));
  const KrylovOutcome outcome =
      gmres(product_with(matrix), copy, VectorX<double>::Ones(kSize), 1e-10, kSize, solution);
  EXPECT_TRUE(solution.allFinite());
  EXPECT_GT(outcome.residual, 0.5);  // and it says so
}

}  // namespace
}  // namespace weft::reference
