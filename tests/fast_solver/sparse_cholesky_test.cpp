#include <gtest/gtest.h>
#include <Eigen/Cholesky>

#include <weft/custom_forces/core/error.hpp>
#include <weft/fast_solver/minimum_degree.hpp>
#include <weft/fast_solver/sparse_cholesky.hpp>

#include "tests/fast_solver/dense_matrix.hpp"

namespace weft::fast {
namespace {

/// Laplacian of an n x n grid with two rings of neighbours, plus mass.
SymmetricMatrix grid_matrix(int n, double mass) {
  std::vector<MatrixPart> parts;
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      const int node = j * n + i;
      parts.push_back({node, node, mass});
      for (const auto& [di, dj] : {std::pair(1, 0), {0, 1}, {1, 1}, {2, 0}, {0, 2}}) {
        if (i + di >= n || j + dj >= n) continue;
        const int other = (j + dj) * n + i + di;
        const double weight = 1.0 + 0.1 * ((node * 7) % 5);
        parts.push_back({node, node, weight});
        parts.push_back({other, other, weight});
        parts.push_back({node, other, -weight});
      }
    }
  }
  return sum_of_parts(n * n, parts);
}

std::vector<int> natural_order(int n) {
  std::vector<int> order(static_cast<std::size_t>(n));
  for (int i = 0; i < n; ++i) order[static_cast<std::size_t>(i)] = i;
  return order;
}

void solve(SparseCholesky& cholesky, const Matrix3X<float>& right, Matrix3X<float>& result) {
  ThreadTeam alone;
  cholesky.solve(right, result, alone);
}

// Tolerance: single precision times a condition number of about 200.
constexpr double kTolerance = 200 * 6e-8;

TEST(SparseCholesky, SolvesWhatADenseFactorisationSolves) {
  for (const int n : {1, 2, 3, 7, 20}) {
    const SymmetricMatrix matrix = grid_matrix(n, 0.1);
    const Matrix3X<float> right = Matrix3X<float>::Random(3, n * n);
    const Eigen::MatrixXd expected = dense(matrix).llt().solve(right.cast<double>().transpose());
    for (const auto& order : {natural_order(n * n), minimum_degree_order(matrix)}) {
      SparseCholesky cholesky(matrix, order);
      Matrix3X<float> result(3, n * n);
      solve(cholesky, right, result);
      EXPECT_LT((result.cast<double>().transpose() - expected).norm(), kTolerance * expected.norm())
          << n << " x " << n;
    }
  }
}

TEST(SparseCholesky, SolvesParts) {
  // Two pieces without a connection, and an unknown of its own: a forest, not a tree.
  const SymmetricMatrix matrix = sum_of_parts(
      5, {{0, 0, 2}, {1, 1, 2}, {0, 1, -1}, {2, 2, 4}, {3, 3, 3}, {4, 4, 3}, {3, 4, 1}});
  SparseCholesky cholesky(matrix, natural_order(5));
  Matrix3X<float> right = Matrix3X<float>::Zero(3, 5);
  right.row(1) << 3, 0, 8, 8, 0;
  Matrix3X<float> result(3, 5);
  solve(cholesky, right, result);
  const Eigen::Matrix<float, 1, 5> expected(2, 1, 2, 3, -1);
  EXPECT_LT((result.row(1) - expected).norm(), 1e-5F);
  EXPECT_EQ(result.row(0).norm(), 0.0F);
}

TEST(SparseCholesky, LeavesColumnsWithoutAnUnknownAlone) {
  const SymmetricMatrix matrix = sum_of_parts(2, {{0, 0, 2}, {1, 1, 4}});
  SparseCholesky cholesky(matrix, natural_order(2), {3, 1});
  const Matrix3X<float> right = Matrix3X<float>::Constant(3, 4, 8);
  Matrix3X<float> result = Matrix3X<float>::Constant(3, 4, -5);
  solve(cholesky, right, result);
  const Eigen::Matrix<float, 1, 4> expected(-5, 2, -5, 4);
  EXPECT_LT((result.row(2) - expected).norm(), 1e-6F);
  EXPECT_EQ(result(2, 0), -5);
}

TEST(SparseCholesky, ThreadsChangeNoBit) {
  const SymmetricMatrix matrix = grid_matrix(60, 0.1);
  const Matrix3X<float> right = Matrix3X<float>::Random(3, 3600);
  const auto solve_by = [&](int num_threads) {
    ThreadTeam team;
    const ThreadTeam::Scope scope(team, num_threads);
    SparseCholesky cholesky(matrix, minimum_degree_order(matrix));
    Matrix3X<float> result(3, 3600);
    cholesky.solve(right, result, team);
    return result;
  };
  EXPECT_EQ(solve_by(1), solve_by(4));
}

TEST(SparseCholesky, RefusesAMatrixThatIsNotPositiveDefinite) {
  const SymmetricMatrix matrix = sum_of_parts(2, {{0, 0, 1}, {1, 1, 1}, {0, 1, -2}});
  EXPECT_THROW(SparseCholesky(matrix, natural_order(2)), InvalidArgument);
}

TEST(SumOfParts, AddsPartsOfTheSamePlace) {
  const SymmetricMatrix matrix = sum_of_parts(3, {{0, 2, 1}, {2, 0, 2}, {1, 1, 5}, {1, 1, 1}});
  EXPECT_EQ(matrix.columns, (std::vector<int>{2, 0}));
  EXPECT_EQ(matrix.values, (std::vector<double>{3, 3}));
  EXPECT_EQ(matrix.diagonal, (std::vector<double>{0, 6, 0}));
}

}  // namespace
}  // namespace weft::fast
