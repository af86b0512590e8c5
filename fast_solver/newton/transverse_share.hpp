#pragma once

// Tested by tests/fast_solver/newton/transverse_share_test.cpp.

#include <algorithm>

namespace weft::fast {

/// The least transverse over axial stiffness that the linearization gives springs [-]. Without any, Newton's steps are largest; with
/// 1 the model bounds the energy from above, and each step lowers it (Bouaziz et al. 2014).
class TransverseShare {
 public:
  [[nodiscard]] double value() const { return share_; }
  [[nodiscard]] bool is_largest() const { return share_ == 1; }

  /// An iteration has been taken back.
  void grow() { share_ = std::min(1.0, std::max(kFirst, kGrowth * share_)); }
  /// One has not.
  void shrink() { share_ = share_ > kFirst ? share_ / kGrowth : 0.0; }
  void forget() { share_ = 0; }

 private:
  /// With 1 at once no iteration gains much.
  static constexpr double kFirst = 0.02;
  static constexpr double kGrowth = 7;

  double share_ = 0;
};

}  // namespace weft::fast
