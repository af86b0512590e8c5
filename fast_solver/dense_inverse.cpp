#include <weft/fast_solver/dense_inverse.hpp>

#include <algorithm>
#include <cmath>

#include <weft/custom_forces/core/types.hpp>
#include <weft/fast_solver/network_kernel.hpp>

namespace weft::fast {
namespace {

/// Half precision ends a little below 2^16.
constexpr int kMostHalfExponent = 14;

}  // namespace

int DenseInverse::filled_size() const {
  return (size_ + kDenseRows - 1) / kDenseRows * kDenseRows;
}

DenseInverse::DenseInverse(SparseCholesky& factor) : size_(factor.size()) {
  const int n = filled_size();
  Eigen::MatrixXf inverse = Eigen::MatrixXf::Zero(n, n);
  ThreadTeam alone;
  Matrix3X<float> right = Matrix3X<float>::Zero(3, size_);
  Matrix3X<float> solution(3, size_);
  for (int first = 0; first < size_; first += 3) {
    const int count = std::min(3, size_ - first);
    for (int k = 0; k < count; ++k) right(k, first + k) = 1;
    factor.solve(right, solution, alone);
    for (int k = 0; k < count; ++k) {
      right(k, first + k) = 0;
      inverse.col(first + k).head(size_) = solution.row(k).transpose();
    }
  }
  const float most = size_ > 0 ? inverse.diagonal().maxCoeff() : 1.0F;
  scale_ = std::ldexp(1.0F, kMostHalfExponent - std::ilogb(most));
  inverse *= scale_;
  entries_.resize(static_cast<std::size_t>(n) * static_cast<std::size_t>(n));
  std::uint16_t* to = entries_.data();
  for (int row = 0; row < n; row += kDenseRows) {
    for (int column = 0; column < n; ++column, to += kDenseRows) {
      vector_kernel().to_halves(inverse.col(column).data() + row, kDenseRows, to);
    }
  }
}

void DenseInverse::multiply(const Fours& right, Fours& result, ThreadTeam& team) const {
  const int n = filled_size();
  const int num_groups = n / kDenseRows;
  const int num_parts = std::min(num_groups, ThreadTeam::kMostParts);
  team.run(num_parts, [&](int part) {
    for (int g = num_groups * part / num_parts; g < num_groups * (part + 1) / num_parts; ++g) {
      const std::ptrdiff_t first = std::ptrdiff_t{g} * kDenseRows;
      vector_kernel().multiply_dense(entries_.data() + first * n, n, 1 / scale_, right.data(),
                                     result.data() + 4 * first);
    }
  });
}

}  // namespace weft::fast
