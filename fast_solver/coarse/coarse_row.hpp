#pragma once

// Tested by tests/fast_solver/coarse/coarse_correction_test.cpp.

#include <array>
#include <cmath>
#include <utility>

#include <weft/core/index.hpp>

namespace weft::fast {

/// A sparse row: coefficients of some coarse basis functions.
struct CoarseRow {
  struct Entry {
    int basis;
    float coefficient;
  };
  std::array<Entry, 6> entries;  ///< those of two nodes at most
  int count = 0;

  [[nodiscard]] const Entry* begin() const { return entries.data(); }
  [[nodiscard]] const Entry* end() const { return entries.data() + count; }
  void add(int basis, float coefficient) {
    for (int k = 0; k < count; ++k) {
      if (entries[at(k)].basis != basis) continue;
      entries[at(k)].coefficient += coefficient;
      return;
    }
    entries[at(count++)] = {basis, coefficient};
  }
  /// The largest coefficients, of whatever sign, come first.
  void sort() {
    for (int last = 1; last < count; ++last) {
      for (int k = last; k > 0; --k) {
        Entry& before = entries[at(k - 1)];
        Entry& one = entries[at(k)];
        if (!(std::abs(one.coefficient) > std::abs(before.coefficient))) break;
        std::swap(one, before);
      }
    }
  }
};

}  // namespace weft::fast
