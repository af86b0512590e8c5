#pragma once

// Tested by tests/custom_forces/laws/elastic/torsion_test.cpp, tests/custom_forces/laws/elastic/nonlocal_torsion_test.cpp.

#include <cmath>

#include <weft/core/tangent.hpp>
#include <weft/custom_forces/assembly/arc_tangent.hpp>

namespace weft::forces {

/// An angle between two unit vectors as laws need it: by its cosine and the square of its sine, both
/// smooth where the angle itself is not.

/// Squared sine below which a series replaces the quotient angle / sine [-]: its first missing term,
/// 231 s^12 / 13312, is 2e-14 there.
inline constexpr double kSmallSquaredSine = 1e-2;
/// Squared sine below which two opposite directions leave no plane to turn in [-].
inline constexpr double kOppositeSquaredSine = 1e-12;

/// angle / sin(angle), smooth at 0; not for opposite directions. Without branches, for the vector unit.
template <class Number>
[[nodiscard]] Number angle_over_sine(const Number& cosine, const Number& squared_sine) {
  using std::sqrt;
  const Number& q = squared_sine;
  // asin(s) / s with q = s^2
  const Number tail(Number(105.0 / 3456) + q * Number(945.0 / 42240));
  const Number fourth(Number(3.0 / 40) + q * Number(Number(15.0 / 336) + q * tail));
  const Number series(Number(1) + q * Number(Number(1.0 / 6) + q * fourth));
  const bool is_small = choose(cosine > Number(0), q, Number(1)) < Number(kSmallSquaredSine);
  const Number sine(sqrt(choose(is_small, Number(1), q)));
  const Number quotient(arc_tangent(sine, cosine) / sine);
  return choose(is_small, series, quotient);
}

template <class Number>
[[nodiscard]] bool is_opposite(const Number& cosine, const Number& squared_sine) {
  return choose(cosine < Number(0), squared_sine, Number(1)) < Number(kOppositeSquaredSine);
}

}  // namespace weft::forces
