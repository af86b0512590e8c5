#pragma once

// Tested by tests/fast_solver/newton/extrapolation_test.cpp.

namespace weft::fast {

/// How far to go along an iteration's step, in its own length: to where the parabola through the slope at its start and the energy
/// at its end is lowest (Nocedal and Wright 2006, section 3.5), at most 10; 1 if that is not 1.5 or more. Sheets that buckle are
/// softer across than a linearization without negative stiffness knows.
/// slope: the residual's work with the step [J], > 0. lowered: the energy's fall over the step [J]. least_fall: a smaller one says
/// nothing of curvature, because of rounding [J].
[[nodiscard]] inline double extrapolation_length(double slope, double lowered, double least_fall) {
  constexpr double kLeast = 1.5;
  constexpr double kMost = 10;
  if (!(lowered > least_fall)) return 1;
  const double curvature = 2 * (slope - lowered);
  const double length = slope < kMost * curvature ? slope / curvature : kMost;
  return length >= kLeast ? length : 1;
}

}  // namespace weft::fast
