#include <cmath>

#include <gtest/gtest.h>

#include <weft/core/symmetric_matrix.hpp>

namespace weft {
namespace {

// The second difference of n values: eigenvalues 2 - 2 cos(k pi / (n + 1)).
Eigen::MatrixXd second_difference(int n) {
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(n, n);
  matrix.diagonal().setConstant(2.0);
  matrix.diagonal<1>().setConstant(-1.0);
  matrix.diagonal<-1>().setConstant(-1.0);
  return matrix;
}

TEST(SymmetricMatrix, ModesAreThoseOfTheSecondDifference) {
  constexpr int kSize = 40;
  const Eigen::MatrixXd matrix = second_difference(kSize);
  const SymmetricModes modes = symmetric_modes(matrix);
  for (int k = 0; k < kSize; ++k) {
    EXPECT_NEAR(modes.values[k], 2.0 - 2.0 * std::cos((k + 1) * EIGEN_PI / (kSize + 1)), 1e-13);
  }
  const Eigen::MatrixXd again =
      modes.vectors * modes.values.asDiagonal() * modes.vectors.transpose();
  EXPECT_LT((again - matrix).norm(), 1e-13 * kSize);
  EXPECT_LT(
      (modes.vectors.transpose() * modes.vectors - Eigen::MatrixXd::Identity(kSize, kSize)).norm(),
      1e-13 * kSize);
}

TEST(SymmetricMatrix, SolvesForSeveralRightSides) {
  constexpr int kSize = 40;
  const Eigen::MatrixXd matrix = second_difference(kSize);
  // A parabola has a constant second difference: x_i = i (n + 1 - i) / 2 for i = 1 to n.
  Eigen::MatrixXd right(kSize, 2);
  right.col(0).setOnes();
  right.col(1).setConstant(-3.0);
  const Eigen::MatrixXd solution = solve_symmetric(matrix, right);
  for (int i = 1; i <= kSize; ++i) {
    EXPECT_NEAR(solution(i - 1, 0), 0.5 * i * (kSize + 1 - i), 1e-10);
    EXPECT_NEAR(solution(i - 1, 1), -1.5 * i * (kSize + 1 - i), 1e-10);
  }
}

}  // namespace
}  // namespace weft
