#include <gtest/gtest.h>
#include <Eigen/Cholesky>

#include <weft/fast_solver/coarse_nodes.hpp>
#include <weft/fast_solver/global_correction.hpp>

#include "tests/fast_solver/dense_matrix.hpp"

namespace weft::fast {
namespace {

/// Springs between neighbours of an n x n grid, hung up by stiff springs at two corners.
SymmetricMatrix hung_grid(int n, double mass) {
  std::vector<MatrixPart> parts;
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      const int node = j * n + i;
      parts.push_back({node, node, mass + (j == 0 && (i == 0 || i == n - 1) ? 10.0 : 0.0)});
      for (const auto& [di, dj] : {std::pair(1, 0), {0, 1}, {1, 1}, {2, 0}, {0, 2}}) {
        if (i + di >= n || j + dj >= n) continue;
        const int other = (j + dj) * n + i + di;
        parts.push_back({node, node, 1.0});
        parts.push_back({other, other, 1.0});
        parts.push_back({node, other, -1.0});
      }
    }
  }
  return sum_of_parts(n * n, parts);
}

Eigen::MatrixXd dense(const Interpolation& p) {
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(p.size(), p.num_coarse);
  for (int i = 0; i < p.size(); ++i) {
    const auto row = static_cast<std::size_t>(i);
    for (int e = p.starts[row]; e < p.starts[row + 1]; ++e) {
      result(i, p.columns[static_cast<std::size_t>(e)]) += p.values[static_cast<std::size_t>(e)];
    }
  }
  return result;
}

TEST(Interpolation, KeepsARigidShiftWhereNothingHolds) {
  const SymmetricMatrix matrix = hung_grid(20, 0.0);
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(make_interpolation(matrix).num_coarse);
  const Eigen::VectorXd shifted = dense(make_interpolation(matrix)) * ones;
  int num_held = 0;
  for (int i = 0; i < shifted.size(); ++i) {
    EXPECT_LT(shifted[i], 1 + 1e-12);
    if (shifted[i] < 1 - 1e-12) ++num_held;
  }
  EXPECT_LE(num_held, 2);  // the corners at most
  EXPECT_LT(ones.size(), 400 * 0.4);
}

TEST(Interpolation, MakesTheMatrixOfTheCoarseNodes) {
  const SymmetricMatrix matrix = hung_grid(12, 0.3);
  const Interpolation p = make_interpolation(matrix);
  const Eigen::MatrixXd expected = dense(p).transpose() * dense(matrix) * dense(p);
  EXPECT_LT((dense(coarse_matrix(matrix, p)) - expected).norm(), 1e-13 * expected.norm());
}

TEST(Interpolation, GoesThroughTwoLevelsAtOnce) {
  const SymmetricMatrix matrix = hung_grid(20, 0.3);
  const Interpolation first = make_interpolation(matrix);
  const Interpolation second = make_interpolation(coarse_matrix(matrix, first));
  EXPECT_LT((dense(composed(first, second)) - dense(first) * dense(second)).norm(), 1e-13);
}

void correct(GlobalCorrection& correction, const NodeArrays<float>& residual,
             NodeArrays<float>& result) {
  ThreadTeam alone;
  const auto rows = static_cast<int>(residual.rows());
  correction.set_residual({0, rows}, residual, NodeArrays<float>::Zero(rows, 3));
  correction.solve(alone);
  for (int part = 0; part < correction.num_parts(); ++part) correction.interpolate(part, result);
}

TEST(GlobalCorrection, SolvesOnTheCoarseNodes) {
  const int n = 15;
  const SymmetricMatrix matrix = hung_grid(n, 0.3);
  // Nodes 0 ... 4 are no unknowns.
  std::vector<int> names;
  for (int i = 0; i < n * n; ++i) names.push_back(i + 5);
  GlobalCorrection correction(matrix, names, n * n + 5);
  const int rows = fill_up(n * n + 5);
  NodeArrays<float> residual = NodeArrays<float>::Zero(rows, 3);
  residual.topRows(n * n + 5).setRandom();
  NodeArrays<float> result = NodeArrays<float>::Ones(rows, 3);
  correct(correction, residual, result);
  const Eigen::MatrixXd p = dense(make_interpolation(matrix));
  const Eigen::MatrixXd right = residual.middleRows(5, n * n).cast<double>();
  const Eigen::MatrixXd expected =
      p * (p.transpose() * dense(matrix) * p).llt().solve(p.transpose() * right);
  const Eigen::MatrixXd found = result.middleRows(5, n * n).cast<double>();
  // The inverse of few coarse unknowns is kept in half precision, 2^-11.
  EXPECT_LT((found - expected).norm(), 5e-4 * expected.norm());
  EXPECT_TRUE(result.topRows(5).isZero(0));
  EXPECT_TRUE(result.bottomRows(rows - n * n - 5).isZero(0));
}

TEST(GlobalCorrection, CorrectsNothingWhereAllIsPinned) {
  GlobalCorrection correction(SymmetricMatrix{{0}, {}, {}, {}}, {}, 3);
  const int rows = fill_up(3);
  NodeArrays<float> residual = NodeArrays<float>::Zero(rows, 3);
  residual.topRows(3).setOnes();
  NodeArrays<float> result = NodeArrays<float>::Ones(rows, 3);
  correct(correction, residual, result);
  EXPECT_TRUE(result.isZero(0));
}

// What the correction is for: it takes a smooth error away, whatever the number of nodes.
TEST(GlobalCorrection, TakesASmoothErrorAway) {
  for (const int n : {20, 170}) {  // 170: through two levels
    const SymmetricMatrix matrix = hung_grid(n, 1e-4);
    std::vector<int> names;
    for (int i = 0; i < n * n; ++i) names.push_back(i);
    GlobalCorrection correction(matrix, names, n * n);
    const int rows = fill_up(n * n);
    NodeArrays<float> error = NodeArrays<float>::Zero(rows, 3);
    NodeArrays<float> residual = NodeArrays<float>::Zero(rows, 3);
    for (int i = 0; i < n * n; ++i) error(i, 0) = 1.0F + static_cast<float>(i / n) / float(n);
    for (int i = 0; i < n * n; ++i) {
      const auto row = static_cast<std::size_t>(i);
      double sum = matrix.diagonal[row] * static_cast<double>(error(i, 0));
      for (int e = matrix.starts[row]; e < matrix.starts[row + 1]; ++e) {
        const auto entry = static_cast<std::size_t>(e);
        sum += matrix.values[entry] * static_cast<double>(error(matrix.columns[entry], 0));
      }
      residual(i, 0) = static_cast<float>(sum);
    }
    NodeArrays<float> result(rows, 3);
    correct(correction, residual, result);
    // Interpolation is exact for a shift; of this plane, with a kink at the corners, 0.20 and 0.22 are left.
    EXPECT_LT((result - error).norm(), 0.3F * error.norm()) << n;
    if (n == 170) {
      EXPECT_LT(correction.size(), n * n / 6);
    }
  }
}

}  // namespace
}  // namespace weft::fast
