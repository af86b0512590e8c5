// What a global correction is made of: sums over nodes and the inverse between coarse unknowns.
#include <gtest/gtest.h>
#include <Eigen/Cholesky>

#include <weft/fast_solver/dense_inverse.hpp>
#include <weft/fast_solver/minimum_degree.hpp>
#include <weft/fast_solver/weighted_sums.hpp>

#include "tests/fast_solver/dense_matrix.hpp"

namespace weft::fast {
namespace {

std::vector<WeightedSums::Row> random_rows(int num_rows, int num_columns) {
  std::srand(11);
  std::vector<WeightedSums::Row> rows(static_cast<std::size_t>(num_rows));
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const int num_terms = r == 3 ? num_columns : std::rand() % 7;  // a long one, and empty ones
    for (int k = 0; k < num_terms; ++k) {
      rows[r].emplace_back(std::rand() % num_columns,
                           static_cast<float>(std::rand() % 100) / 100.0F);
    }
  }
  return rows;
}

TEST(WeightedSums, AreThoseOfEachRow) {
  const int num_columns = 40;
  const auto rows = random_rows(90, num_columns);
  WeightedSums sums(rows, {30, 30, 77, 90});
  Fours values = Fours::Random(4, num_columns);
  Fours result = Fours::Constant(4, 92, -1.0F);
  for (int part = 0; part < sums.num_parts(); ++part) sums.multiply(part, values, result);
  sums.add_term(5, 39, 2.0F);
  sums.add_late_terms(values, result);
  for (int r = 0; r < 90; ++r) {
    Eigen::Vector4f expected = Eigen::Vector4f::Zero();
    for (const auto& [column, weight] : rows[static_cast<std::size_t>(r)]) {
      expected += weight * values.col(column);
    }
    if (r == 5) expected += 2.0F * values.col(39);
    // Single precision, up to forty terms.
    EXPECT_LT((result.col(r) - expected).norm(), 1e-5F) << r;
    std::size_t num_terms = 0;
    sums.for_each_term(r, [&](int, float) { ++num_terms; });
    EXPECT_EQ(num_terms, rows[static_cast<std::size_t>(r)].size() + (r == 5 ? 1 : 0));
  }
  EXPECT_TRUE(result.rightCols(2).isConstant(-1.0F, 0));
}

TEST(DenseInverse, SolvesWhatTheMatrixSays) {
  for (const int n : {1, 5, 31, 32, 33, 100}) {
    std::vector<MatrixPart> parts;
    for (int i = 0; i < n; ++i) {
      parts.push_back({i, i, 3e-5});
      if (i > 0) parts.push_back({i - 1, i, -1e-5});
      if (i >= 7) parts.push_back({i - 7, i, -2e-6});
    }
    const SymmetricMatrix matrix = sum_of_parts(n, parts);
    SparseCholesky factor(matrix, minimum_degree_order(matrix));
    const DenseInverse inverse(factor);
    Fours right = Fours::Zero(4, inverse.filled_size());
    right.topLeftCorner(3, n).setRandom();
    Fours result(4, inverse.filled_size());
    ThreadTeam team;
    const ThreadTeam::Scope scope(team, 3);
    inverse.multiply(right, result, team);
    const Eigen::MatrixXd expected =
        dense(matrix).llt().solve(right.topLeftCorner(3, n).transpose().cast<double>());
    const Eigen::MatrixXd found = result.topLeftCorner(3, n).transpose().cast<double>();
    // Entries are kept in half precision.
    EXPECT_LT((found - expected).norm(), 5e-4 * expected.norm()) << n;
    EXPECT_TRUE(result.rightCols(inverse.filled_size() - n).isZero(0));
  }
}

}  // namespace
}  // namespace weft::fast
