#include <weft/fast_solver/dense_inverse.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include <weft/custom_forces/core/types.hpp>
#include <weft/fast_solver/network_kernel.hpp>

namespace weft::fast {
namespace {

/// Half precision ends a little below 2^16.
constexpr int kMostHalfExponent = 14;
/// Root mean square of what rounding to half precision changes numbers by, over the numbers: 2^-11 / sqrt(12), and a
/// half more for those that begin with small digits.
constexpr double kHalfRounding = 2e-4;
/// Of the least that the inverse does to a vector: what rounding may change it by.
constexpr double kMostNoise = 0.5;

std::size_t at(Eigen::Index i) {
  return static_cast<std::size_t>(i);
}

}  // namespace

int DenseInverse::filled_size() const {
  return (size() + kDenseRows - 1) / kDenseRows * kDenseRows;
}

// Several columns at once: each sum would wait for the one before.
void DenseInverse::sum_pieces(const Fours& right) {
  constexpr int kTogether = 4;
  sums_.setZero();
  for (const Run& run : runs_) {
    Eigen::Matrix<float, 4, kTogether> sums = Eigen::Matrix<float, 4, kTogether>::Zero();
    int i = run.begin;
    for (; i + kTogether <= run.end; i += kTogether) sums += right.middleCols<kTogether>(i);
    for (; i < run.end; ++i) sums.col(0) += right.col(i);
    sums_.col(run.piece) += sums.rowwise().sum();
  }
}

void DenseInverse::multiply(const Fours& right, Fours& result, ThreadTeam& team) {
  const int n = filled_size();
  sum_pieces(right);
  const int num_groups = n / kDenseRows;
  const int num_parts = std::min(num_groups, ThreadTeam::kMostParts);
  team.run(num_parts, [&](int part) {
    const int begin = num_groups * part / num_parts * kDenseRows;
    const int end = num_groups * (part + 1) / num_parts * kDenseRows;
    for (std::ptrdiff_t first = begin; first < end; first += kDenseRows) {
      vector_kernel().multiply_dense(entries_.data() + first * n, n, 1 / scale_, right.data(),
                                     result.data() + 4 * first);
    }
    for (int i = begin; i < std::min(end, size()); ++i) {
      const int piece = piece_of_[at(i)];
      result.col(i) += shares_[at(piece)] * sums_.col(piece);
    }
  });
}

DenseInverseMaker::DenseInverseMaker(const SymmetricMatrix& matrix, SparseCholesky& factor)
    : matrix_(matrix), factor_(factor) {
  find_pieces();
  find_runs();
  const int n = result_.filled_size();
  inverse_.setZero(n, n);
  right_.setZero(3, matrix.size());
  solution_.setZero(3, matrix.size());
}

// Unknowns that springs connect.
void DenseInverseMaker::find_pieces() {
  std::vector<int>& piece_of = result_.piece_of_;
  piece_of.assign(at(matrix_.size()), -1);
  std::vector<int> open;
  for (int first = 0; first < matrix_.size(); ++first) {
    if (piece_of[at(first)] >= 0) continue;
    const auto piece = static_cast<int>(result_.shares_.size());
    result_.shares_.push_back(0);
    open.assign(1, first);
    piece_of[at(first)] = piece;
    while (!open.empty()) {
      const int i = open.back();
      open.pop_back();
      for (int e = matrix_.starts[at(i)]; e < matrix_.starts[at(i) + 1]; ++e) {
        const int other = matrix_.columns[at(e)];
        if (piece_of[at(other)] >= 0) continue;
        piece_of[at(other)] = piece;
        open.push_back(other);
      }
    }
  }
}

void DenseInverseMaker::find_runs() {
  for (int i = 0; i < matrix_.size(); ++i) {
    const int piece = result_.piece_of_[at(i)];
    if (result_.runs_.empty() || result_.runs_.back().piece != piece) {
      result_.runs_.push_back({piece, i, i});
    }
    result_.runs_.back().end = i + 1;
  }
}

bool DenseInverseMaker::add_columns(int count) {
  ThreadTeam alone;
  const int n = matrix_.size();
  for (const int end = std::min(n, next_ + count); next_ < end;) {
    const int width = std::min(3, end - next_);
    for (int k = 0; k < width; ++k) right_(k, next_ + k) = 1;
    factor_.solve(right_, solution_, alone);
    for (int k = 0; k < width; ++k) {
      right_(k, next_ + k) = 0;
      inverse_.col(next_ + k).head(n) = solution_.row(k).transpose();
    }
    next_ += width;
  }
  return next_ == n;
}

// The norm of a random matrix beside the least that the inverse makes of a vector, which the largest number on the
// diagonal of A says.
bool DenseInverseMaker::is_exact_enough() const {
  const double n = matrix_.size();
  const double stiffest = 2 * *std::max_element(matrix_.diagonal.begin(), matrix_.diagonal.end());
  const double noise = 2 * kHalfRounding * static_cast<double>(inverse_.norm()) / std::sqrt(n);
  return noise * stiffest <= kMostNoise;
}

std::optional<DenseInverse> DenseInverseMaker::take() {
  const std::vector<int>& piece_of = result_.piece_of_;
  const auto n = static_cast<Eigen::Index>(piece_of.size());
  std::vector<double> sums(result_.shares_.size(), 0.0);
  std::vector<double> sizes(result_.shares_.size(), 0.0);
  for (Eigen::Index i = 0; i < n; ++i) {
    sums[at(piece_of[at(i)])] += static_cast<double>(inverse_.col(i).sum());
    sizes[at(piece_of[at(i)])] += 1;
  }
  for (std::size_t piece = 0; piece < sums.size(); ++piece) {
    result_.shares_[piece] = static_cast<float>(sums[piece] / (sizes[piece] * sizes[piece]));
  }
  for (Eigen::Index column = 0; column < n; ++column) {
    for (Eigen::Index row = 0; row < n; ++row) {
      const int piece = piece_of[at(row)];
      if (piece == piece_of[at(column)]) inverse_(row, column) -= result_.shares_[at(piece)];
    }
  }
  if (!is_exact_enough()) return std::nullopt;
  const float most = inverse_.cwiseAbs().maxCoeff();
  if (most > 0)
    result_.scale_ = std::ldexp(1.0F, std::min(kMostHalfExponent - std::ilogb(most), 100));
  inverse_ *= result_.scale_;
  const Eigen::Index filled = inverse_.rows();
  result_.entries_.resize(at(filled * filled));
  std::uint16_t* to = result_.entries_.data();
  for (Eigen::Index row = 0; row < filled; row += kDenseRows) {
    for (Eigen::Index column = 0; column < filled; ++column, to += kDenseRows) {
      vector_kernel().to_halves(inverse_.col(column).data() + row, kDenseRows, to);
    }
  }
  result_.sums_.setZero(4, static_cast<Eigen::Index>(result_.shares_.size()));
  return std::move(result_);
}

}  // namespace weft::fast
