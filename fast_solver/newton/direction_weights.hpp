#pragma once

// Tested by tests/fast_solver/implicit_solver_test.cpp.

#include <array>
#include <cstddef>

namespace weft::fast {

/// Coefficients of the directions and of the step of conjugate gradients, in terms of preconditioned residuals c:
///
///   d_k = c_k - beta_k d_(k-1),   step = sum of alpha_k d_k
///
/// Only the c are stored, because no direction is needed before several iterations are done.
class DirectionWeights {
 public:
  /// Corrections that are kept; then step and direction are summed up.
  static constexpr int kMost = 4;
  /// Weights of c_0, c_1, ... and, at count(), of the direction before c_0.
  using Weights = std::array<float, kMost + 1>;

  void clear() { count_ = 0; }
  void add(float beta, float alpha) {
    betas_[static_cast<std::size_t>(count_)] = beta;
    alphas_[static_cast<std::size_t>(count_)] = alpha;
    ++count_;
  }
  [[nodiscard]] int count() const { return count_; }
  [[nodiscard]] bool is_full() const { return count_ == kMost; }

  [[nodiscard]] Weights of_step() const { return sum_of(alphas_); }
  [[nodiscard]] Weights of_last_direction() const {
    std::array<float, kMost> only_last{};
    if (count_ > 0) only_last[static_cast<std::size_t>(count_ - 1)] = 1;
    return sum_of(only_last);
  }

 private:
  /// The weights of the sum of factors_k d_k.
  [[nodiscard]] Weights sum_of(const std::array<float, kMost>& factors) const {
    Weights weights{};
    float of_next = 0;  // the coefficient of d_(k+1), times -beta_(k+1)
    for (int k = count_ - 1; k >= 0; --k) {
      const auto i = static_cast<std::size_t>(k);
      weights[i] = factors[i] + of_next;
      of_next = -betas_[i] * weights[i];
    }
    weights[static_cast<std::size_t>(count_)] = of_next;
    return weights;
  }

  int count_ = 0;
  std::array<float, kMost> betas_{};
  std::array<float, kMost> alphas_{};
};

}  // namespace weft::fast
