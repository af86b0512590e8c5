#pragma once

// Tested by tests/validation/metrics/series/time_series_test.cpp.

#include <optional>
#include <span>

namespace weft::validation {

/// y = intercept + slope x.
struct LineFit {
  double slope = 0.0;
  double intercept = 0.0;
  /// Share of the variance of y that the line explains [-]; 1 if y does not vary.
  double r_squared = 0.0;
};

/// Least-squares line through points. None with fewer than two different x, or if a number is not
/// finite. Throws InvalidArgument if x and y differ in number.
[[nodiscard]] std::optional<LineFit> fit_line(std::span<const double> x, std::span<const double> y);

}  // namespace weft::validation
