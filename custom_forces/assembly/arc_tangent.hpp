#pragma once

// Tested by tests/custom_forces/assembly/arc_tangent_test.cpp.

#include <cmath>
#include <cstddef>
#include <type_traits>

#include <weft/core/tangent.hpp>

namespace weft::forces {

/// (atan(t) / t - 1) / t^2 as a polynomial in t^2, for |t| <= tan(pi / 8): it interpolates at the zeros of a Chebyshev
/// polynomial, which leaves a relative error of the arc tangent of 3e-9 (float) and 8e-18 (double).
template <class Scalar>
inline constexpr double kArcTangent[] = {
    -0.3333333333333333,  0.1999999999999552,  -0.14285714284666542, 0.11111111015256361,
    -0.09090904578123903, 0.07692183190826088, -0.06664511447381986, 0.058581489128026465,
    -0.05085449737943034, 0.03923165829568011, -0.019176887119190616};
template <>
inline constexpr double kArcTangent<float>[] = {-0.3333333176116852, 0.19999540483649014,
                                                -0.14263955597986133, 0.10743731490807869,
                                                -0.0645192820818332};

/// The angle of the vector (x, y) in [-pi, pi] to within 3 units in the last place; 0 for the zero vector, not a number where
/// a component is none, or both are infinite. Unlike std::atan2 it has no branch that a vector unit could not take, and gives
/// the same bits with every standard library; -0 counts as 0. Other numbers than float and double use the atan2() of their own.
template <class Number>
[[nodiscard, gnu::always_inline]] inline Number arc_tangent(const Number& y, const Number& x) {
  if constexpr (std::is_same_v<Number, float> || std::is_same_v<Number, double>) {
    constexpr auto kPi = Number(3.14159265358979323846);
    constexpr auto kTangentOfEighth = Number(0.41421356237309504880);
    const Number width = std::abs(x);
    const Number height = std::abs(y);
    const bool is_steep = height > width;
    const Number less = is_steep ? width : height;
    const Number more = is_steep ? height : width;
    // Within an eighth of pi of the axis, or of the diagonal.
    const bool is_near_diagonal = less > kTangentOfEighth * more;
    const Number numerator = is_near_diagonal ? less - more : less;
    const Number sum = is_near_diagonal ? less + more : more;
    const Number denominator = sum == Number(0) ? Number(1) : sum;
    const Number t = numerator / denominator;
    const Number squared = t * t;
    constexpr std::size_t kDegree = sizeof(kArcTangent<Number>) / sizeof(double) - 1;
    auto series = Number(kArcTangent<Number>[kDegree]);
    for (std::size_t k = kDegree; k > 0; --k) {
      series = series * squared + Number(kArcTangent<Number>[k - 1]);
    }
    const Number from_axis =
        (t + t * (squared * series)) + (is_near_diagonal ? kPi / 4 : Number(0));
    const Number from_x = is_steep ? kPi / 2 - from_axis : from_axis;
    const Number upper = x < Number(0) ? kPi - from_x : from_x;
    return y < Number(0) ? -upper : upper;
  } else {
    return Number(atan2(y, x));
  }
}

template <class Scalar>
[[nodiscard, gnu::always_inline]] inline Tangent<Scalar> arc_tangent(const Tangent<Scalar>& y,
                                                                     const Tangent<Scalar>& x) {
  return {arc_tangent(y.value, x.value),
          Scalar((x.value * y.rate - y.value * x.rate) / (x.value * x.value + y.value * y.value))};
}

}  // namespace weft::forces
