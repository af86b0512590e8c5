#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>
#include <utility>
#include <vector>

#include <Eigen/Cholesky>

#include <weft/fast_solver/coarse/dissected_cholesky.hpp>

namespace weft::fast {
namespace {

using Pairs = std::vector<std::pair<int, int>>;

/// Springs between neighbors of a grid, across too.
Pairs grid_pairs(int width, int height) {
  Pairs pairs;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      for (const auto& [dx, dy] : Pairs{{1, 0}, {-1, 1}, {0, 1}, {1, 1}}) {
        const bool is_inside = x + dx >= 0 && x + dx < width && y + dy < height;
        if (is_inside) pairs.emplace_back(y * width + x, (y + dy) * width + x + dx);
      }
    }
  }
  return pairs;
}

/// Random springs on them, and the matrix that they make.
struct Problem {
  Problem(int n, const Pairs& pairs)
      : subdomain(n, pairs), inertia(static_cast<std::size_t>(n), 0.1F) {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> number(-1, 1);
    blocks.assign(static_cast<std::size_t>(subdomain.num_blocks()) * kBlockNumbers, 0.0F);
    matrix.setIdentity(3 * n, 3 * n);
    matrix *= 0.1;
    const auto make = [&](int block) {
      const Eigen::Vector3f along(number(random), number(random), number(random));
      const Eigen::Matrix3f k = along * along.transpose() + 0.05F * Eigen::Matrix3f::Identity();
      const float numbers[] = {k(0, 0), k(1, 1), k(2, 2), k(0, 1), k(1, 2), k(2, 0)};
      std::copy(numbers, numbers + 6, blocks.begin() + block * kBlockNumbers);
      return k.cast<double>().eval();
    };
    for (int p = 0; p < static_cast<int>(pairs.size()); ++p) {
      const Eigen::Matrix3d k = make(subdomain.pair_block(p));
      const auto [a, b] = pairs[static_cast<std::size_t>(p)];
      matrix.block<3, 3>(3 * a, 3 * a) += k;
      matrix.block<3, 3>(3 * b, 3 * b) += k;
      matrix.block<3, 3>(3 * a, 3 * b) -= k;
      matrix.block<3, 3>(3 * b, 3 * a) -= k;
    }
    for (int i = 0; i < n; i += 5) matrix.block<3, 3>(3 * i, 3 * i) += make(subdomain.own_block(i));
    right.setRandom(4, n);
  }
  Eigen::Matrix4Xf solution(int threads) {
    WorkerTeam team;
    const WorkerTeam::Scope scope(team, threads);
    Eigen::Matrix4Xf result = Eigen::Matrix4Xf::Zero(4, right.cols());
    for (int again = 0; again < 2; ++again) {  // nothing is left of the time before
      subdomain.factorize(blocks.data(), inertia.data(), team);
      const DissectedCholesky::Summand whole{right.data(), 0, static_cast<int>(right.cols())};
      subdomain.solve({&whole, 1}, result.data(), team);
    }
    return result;
  }
  [[nodiscard]] Eigen::Matrix3Xd exact() const {
    const Eigen::Matrix3Xd b = right.topRows<3>().cast<double>();
    return matrix.llt().solve(b.reshaped()).reshaped(3, b.cols());
  }

  DissectedCholesky subdomain;
  std::vector<float> blocks;
  std::vector<float> inertia;
  Eigen::MatrixXd matrix;
  Eigen::Matrix4Xf right;
};

TEST(DissectedCholesky, SolvesWhatADenseFactorisationSolves) {
  for (const auto& [width, height] : Pairs{{1, 1}, {2, 1}, {3, 2}, {7, 9}, {13, 11}, {40, 1}}) {
    Problem problem(width * height, grid_pairs(width, height));
    const Eigen::Matrix3Xd exact = problem.exact();
    const Eigen::Matrix3Xd found = problem.solution(1).topRows<3>().cast<double>();
    // Single precision, and a condition of some hundreds.
    EXPECT_LT((found - exact).norm(), 1e-4 * exact.norm()) << width << " x " << height;
  }
}

TEST(DissectedCholesky, SolvesForPiecesThatKnowNothingOfEachOther) {
  Pairs pairs = grid_pairs(6, 5);
  for (const auto& [a, b] : grid_pairs(4, 4)) pairs.emplace_back(30 + a, 30 + b);
  std::sort(pairs.begin(), pairs.end());
  Problem problem(50, pairs);  // four of them alone
  const Eigen::Matrix3Xd exact = problem.exact();
  const Eigen::Matrix3Xd found = problem.solution(1).topRows<3>().cast<double>();
  EXPECT_LT((found - exact).norm(), 1e-4 * exact.norm());
}

TEST(DissectedCholesky, SumsUpItsRightHandSide) {
  Problem problem(13 * 11, grid_pairs(13, 11));
  const auto whole = problem.solution(1);
  // Ranges that overlap, one that is empty, and what is the sum of them.
  const Eigen::Matrix4Xf low = problem.right.leftCols(90);
  const Eigen::Matrix4Xf high = problem.right.rightCols(100);
  const DissectedCholesky::Summand parts[] = {
      {low.data(), 0, 90}, {nullptr, 20, 20}, {high.data(), 43, 143}};
  Eigen::Matrix4Xf found = Eigen::Matrix4Xf::Zero(4, 143);
  WorkerTeam team;
  problem.subdomain.solve(parts, found.data(), team);
  problem.right.middleCols(43, 47) *= 2;
  const auto expected = problem.solution(1);
  EXPECT_EQ(found, expected);  // of two equal numbers the sum is exact
  EXPECT_NE(found, whole);
}

TEST(DissectedCholesky, LeavesOutWhatNothingHolds) {
  Problem problem(7, grid_pairs(3, 2));
  problem.inertia[6] = 0;
  problem.blocks[static_cast<std::size_t>(problem.subdomain.own_block(6)) * kBlockNumbers] = 0;
  const Eigen::Matrix4Xf found = problem.solution(1);
  EXPECT_TRUE(found.allFinite());
  EXPECT_TRUE(found.col(6).isZero(0));
  EXPECT_FALSE(found.col(5).isZero(1e-3F));
}

TEST(DissectedCholesky, KeepsNothingOfWhatIsNotANumber) {
  Problem problem(13 * 11, grid_pairs(13, 11));
  const Eigen::Matrix4Xf expected = problem.solution(1);
  const Eigen::Matrix4Xf right = problem.right;
  problem.right.setConstant(std::numeric_limits<float>::quiet_NaN());
  (void)problem.solution(1);
  problem.right = right;
  EXPECT_EQ(problem.solution(1), expected);
}

TEST(DissectedCholesky, ThreadsChangeNoBit) {
  Problem problem(13 * 11, grid_pairs(13, 11));
  const Eigen::Matrix4Xf alone = problem.solution(1);
  EXPECT_EQ(alone, problem.solution(2));
}

}  // namespace
}  // namespace weft::fast
