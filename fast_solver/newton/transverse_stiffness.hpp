#pragma once

// Tested by tests/fast_solver/newton/transverse_stiffness_test.cpp.

#include <algorithm>

namespace weft::fast {

/// Least transverse over axial stiffness of springs in the linearization: 0, and more after an iteration that increased the energy,
/// until one does not. With 1 no iteration increases it (as the global step of Bouaziz et al. 2014).
class TransverseStiffness {
 public:
  [[nodiscard]] double share() const { return share_; }
  [[nodiscard]] bool is_raised() const { return share_ > 0; }
  /// After an iteration that increased the energy. False, and 0 again, if there is no more.
  [[nodiscard]] bool raise() {
    const bool has_more = share_ < 1;
    share_ = has_more ? std::clamp(kGrowth * share_, kFirst, 1.0) : 0.0;
    return has_more;
  }
  /// After one that did not.
  void lower() { share_ = share_ > kFirst ? share_ / kGrowth : 0.0; }

 private:
  static constexpr double kFirst = 0.02;
  static constexpr double kGrowth = 7;
  double share_ = 0;
};

}  // namespace weft::fast
