// What a global correction is made of: sums over nodes and the inverse between coarse unknowns.
#include <cstdlib>
#include <optional>
#include <tuple>

#include <gtest/gtest.h>
#include <Eigen/Cholesky>
#include <Eigen/LU>

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
  sums.append(rows[7]);
  sums.multiply_appended(values, result);
  for (int r = 0; r < 91; ++r) {
    const WeightedSums::Row& row = rows[r == 90 ? 7U : static_cast<std::size_t>(r)];
    Eigen::Vector4f expected = Eigen::Vector4f::Zero();
    for (const auto& [column, weight] : row) expected += weight * values.col(column);
    if (r == 5) expected += 2.0F * values.col(39);
    // Single precision, up to forty terms.
    EXPECT_LT((result.col(r) - expected).norm(), 1e-5F) << r;
    WeightedSums::Row terms;
    sums.for_each_term(r, [&](int column, float weight) { terms.emplace_back(column, weight); });
    EXPECT_EQ(terms, row);
  }
  EXPECT_EQ(sums.num_rows(), 91);
  EXPECT_TRUE(result.col(91).isConstant(-1.0F, 0));
}

/// A chain of springs with a few across, and masses.
SymmetricMatrix chain(int n, double stiffness, double mass, int cut) {
  std::vector<MatrixPart> parts;
  const auto connect = [&](int a, int b) {
    if (a < 0 || (a < cut) != (b < cut)) return;
    parts.push_back({a, a, stiffness});
    parts.push_back({b, b, stiffness});
    parts.push_back({a, b, -stiffness});
  };
  for (int i = 0; i < n; ++i) {
    parts.push_back({i, i, mass});
    for (const int distance : {1, 5, 9}) connect(i - distance, i);
  }
  return sum_of_parts(n, parts);
}

std::optional<DenseInverse> inverse_of(const SymmetricMatrix& matrix) {
  SparseCholesky factor(matrix, minimum_degree_order(matrix));
  DenseInverseMaker maker(matrix, factor);
  while (!maker.add_columns(7)) {
  }
  return maker.take();
}

/// Of A^-1 as it is kept, all columns, less that of A^-1.
Eigen::MatrixXd error_of(DenseInverse& inverse, const Eigen::MatrixXd& exact) {
  const Eigen::Index n = exact.rows();
  Eigen::MatrixXd found(n, n);
  ThreadTeam team;
  const ThreadTeam::Scope scope(team, 3);
  for (Eigen::Index column = 0; column < n; ++column) {
    Fours right = Fours::Zero(4, inverse.filled_size());
    right.col(column).head<3>() << 1, 2, -1;
    Fours result(4, inverse.filled_size());
    inverse.multiply(right, result, team);
    found.col(column) = result.row(0).head(n).transpose().cast<double>();
    EXPECT_TRUE(result.row(1).isApprox(2 * result.row(0), 1e-6F));
    EXPECT_TRUE(result.rightCols(inverse.filled_size() - n).isZero(0));
  }
  return found - exact;
}

// What a correction needs: that the inverse is not wrong by more than it is, for any vector. Where masses alone hold
// what springs of 1 MN/m connect, numbers in half precision would be, if they held the motion as a whole too.
TEST(DenseInverse, IsRightForSoftAndStiffMotions) {
  for (const double stiffness : {1.0, 1e3, 1e6}) {
    for (const int n : {1, 5, 31, 32, 33, 100}) {
      for (const int cut : {0, n / 3}) {  // in one piece and in two
        const SymmetricMatrix matrix = chain(n, stiffness, 0.5, cut);
        std::optional<DenseInverse> inverse = inverse_of(matrix);
        ASSERT_TRUE(inverse) << stiffness;
        const Eigen::MatrixXd exact = dense(matrix).inverse();
        const Eigen::MatrixXd root = Eigen::MatrixXd(dense(matrix).llt().matrixL());
        const Eigen::MatrixXd relative =
            root.transpose() * error_of(*inverse, exact) * root;  // zero if exact, -1 if nothing
        // Half precision, and of the stiffest the single precision of the factor.
        EXPECT_LT(relative.norm(), 0.05 + 5e-7 * stiffness)
            << stiffness << " N/m, " << n << ", cut at " << cut;
      }
    }
  }
}

// A long chain whose springs and masses are such that half precision would lose the shortest waves.
TEST(DenseInverse, SaysWhereHalfPrecisionIsTooLittle) {
  std::vector<MatrixPart> parts;
  for (int i = 0; i < 200; ++i) {
    parts.push_back({i, i, 1e-6});
    if (i == 0) continue;
    for (const auto& [a, b, k] : {std::tuple(i - 1, i - 1, 1.0), {i, i, 1.0}, {i - 1, i, -1.0}}) {
      parts.push_back({a, b, i % 2 == 0 ? 1e4 * k : k});
    }
  }
  EXPECT_FALSE(inverse_of(sum_of_parts(200, parts)));
}

}  // namespace
}  // namespace weft::fast
