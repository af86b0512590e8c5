#pragma once

// Tested by tests/fast_solver/coarse/coarse_row_test.cpp.

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
  /// Returns the row without coefficients below a share `least` of the largest one, or whose basis functions are not coupled with
  /// those of larger ones: they are added to the largest one of their sign. Its energy is the square of a difference again. With
  /// terms of the expanded square left out it would not be, and what was left out may be all that holds some mode of springs
  /// back that are much stiffer than inertia. are_coupled(basis, other basis).
  template <class Coupled>
  [[nodiscard]] CoarseRow merged(float least, const Coupled& are_coupled) const {
    const CoarseRow row = sorted();
    CoarseRow result;
    for (const auto& [basis, coefficient] : row) {
      const Entry* alike = nullptr;
      bool is_kept = std::abs(coefficient) > least * std::abs(row.entries[0].coefficient);
      for (const Entry& kept : result) {
        is_kept = is_kept && are_coupled(basis, kept.basis);
        if (alike == nullptr && kept.coefficient * coefficient > 0) alike = &kept;
      }
      result.add(
          is_kept || result.count == 0 ? basis : (alike != nullptr ? alike : result.begin())->basis,
          coefficient);
    }
    return result;
  }

 private:
  /// The largest coefficients, of whatever sign, come first.
  [[nodiscard]] CoarseRow sorted() const {
    CoarseRow result = *this;
    for (int last = 1; last < count; ++last) {
      for (int k = last; k > 0; --k) {
        Entry& before = result.entries[at(k - 1)];
        Entry& one = result.entries[at(k)];
        if (!(std::abs(one.coefficient) > std::abs(before.coefficient))) break;
        std::swap(one, before);
      }
    }
    return result;
  }
};

}  // namespace weft::fast
