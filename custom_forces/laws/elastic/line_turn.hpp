#pragma once

// Tested by tests/custom_forces/laws/elastic/torsion_test.cpp.

#include <weft/core/tangent.hpp>
#include <weft/custom_forces/assembly/batched_kernel.hpp>

namespace weft::forces {

/// The turn of the way A -> C -> B.
template <class Number>
struct LineTurn {
  bool has_sides;              ///< both are long enough to have a direction
  PlainVector<Number> first;   ///< unit vector from A to C
  PlainVector<Number> second;  ///< unit vector from C to B
  Number first_length;         ///< [m]
  Number second_length;        ///< [m]
  Number cosine;               ///< of theta
  Number squared_sine;

  /// sin(theta) dtheta/dx of A, C and B, times a factor.
  [[nodiscard, gnu::always_inline]] Corners<Number, 3> gradient_times(const Number& factor) const {
    const PlainVector<Number> at_first = Number(factor / first_length) * (second - cosine * first);
    const PlainVector<Number> at_second =
        Number(factor / second_length) * (cosine * second - first);
    const PlainVector<Number> at_both = at_first + at_second;
    return {{{at_first.x, at_first.y, at_first.z},
             {Number(-at_both.x), Number(-at_both.y), Number(-at_both.z)},
             {at_second.x, at_second.y, at_second.z}}};
  }
};

/// Without branches, for the vector unit. x: A, C and B. squared_first, squared_second: square of the least length that a side must
/// exceed [m^2]; without sides all numbers are finite, and mean nothing.
template <class Number, class Scalar>
[[nodiscard, gnu::always_inline]] inline LineTurn<Number> line_turn(const Corners<Number, 3>& x,
                                                                    const Scalar& squared_first,
                                                                    const Scalar& squared_second) {
  using std::sqrt;
  const PlainVector<Number> first = x[1] - x[0];
  const PlainVector<Number> second = x[2] - x[1];
  const Number given_first = first.squared_norm();
  const Number given_second = second.squared_norm();
  const Number one(Scalar(1));
  LineTurn<Number> turn;
  const Number second_if_first =
      choose(given_first > Number(squared_first), given_second, Number(Scalar(0)));
  turn.has_sides = second_if_first > Number(squared_second);
  turn.first_length = Number(sqrt(choose(turn.has_sides, given_first, one)));
  turn.second_length = Number(sqrt(choose(turn.has_sides, given_second, one)));
  turn.first = Number(one / turn.first_length) * first;
  turn.second = Number(one / turn.second_length) * second;
  turn.cosine = turn.first.dot(turn.second);
  turn.squared_sine = turn.first.cross(turn.second).squared_norm();
  return turn;
}

}  // namespace weft::forces
