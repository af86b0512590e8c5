#pragma once

// Tested by tests/custom_forces/laws/elastic/torsion_test.cpp, tests/custom_forces/laws/elastic/nonlocal_torsion_test.cpp.

#include <cmath>

namespace weft::forces {

/// An angle between two unit vectors as laws need it: by its cosine and the square of its sine, both
/// smooth where the angle itself is not.

/// Squared sine below which a series replaces the quotient angle / sine [-]: its first missing term,
/// 231 s^12 / 13312, is 2e-14 there.
inline constexpr double kSmallSquaredSine = 1e-2;
/// Squared sine below which two opposite directions leave no plane to turn in [-].
inline constexpr double kOppositeSquaredSine = 1e-12;

/// angle / sin(angle), smooth at 0; not for opposite directions.
template <class Number>
[[nodiscard]] Number angle_over_sine(const Number& cosine, const Number& squared_sine) {
  using std::atan2;
  using std::sqrt;
  const Number& q = squared_sine;
  if (cosine > Number(0) && q < Number(kSmallSquaredSine)) {
    // asin(s) / s with q = s^2
    const Number tail = Number(105.0 / 3456) + q * Number(945.0 / 42240);
    const Number fourth = Number(3.0 / 40) + q * (Number(15.0 / 336) + q * tail);
    return Number(1) + q * (Number(1.0 / 6) + q * fourth);
  }
  const Number sine = sqrt(q);
  return Number(atan2(sine, cosine)) / sine;
}

template <class Number>
[[nodiscard]] bool is_opposite(const Number& cosine, const Number& squared_sine) {
  return cosine < Number(0) && squared_sine < Number(kOppositeSquaredSine);
}

}  // namespace weft::forces
