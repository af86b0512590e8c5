#pragma once

// Tested by tests/apps/CMakeLists.txt.

#include <functional>

#include <weft/reference/solver.hpp>

namespace weft::validation {

/// A flat cloth of 8 x 8 nodes with springs to 12 neighbors, floating free and at rest, with an
/// added inertia beta [-] if it is not 0.
[[nodiscard]] reference::Body floating_cloth(double beta);

/// Width of the bracket in which the search ends, largest over smallest step, minus 1 [-].
inline constexpr double kStepResolution = 1e-3;

/// Largest step [s] at which a small disturbance of a body does not grow, by trying: bisection over
/// runs of modified Euler, between 1e-5 s and 1 s.
[[nodiscard]] double largest_stable_step(const std::function<reference::Body()>& make);

}  // namespace weft::validation
