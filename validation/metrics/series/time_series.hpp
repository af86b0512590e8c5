#pragma once

#include <optional>
#include <span>
#include <string_view>

namespace weft::validation {

// Series are two spans of one length >= 1: strictly increasing, finite times [s], and values of any
// unit. Every function here throws InvalidArgument for anything else, and gives NaN if a value it
// needs is not finite.

/// Throws InvalidArgument that starts with where, unless times and values are a series.
void check_series(std::string_view where, std::span<const double> times,
                  std::span<const double> values);

struct Extreme {
  double time = 0.0;   ///< [s]; of the first value that is not finite, if there is one
  double value = 0.0;  ///< NaN if a value is not finite
};

/// The largest value and when it is first reached.
[[nodiscard]] Extreme largest_over_time(std::span<const double> times,
                                        std::span<const double> values);

/// Time average by the trapezoidal rule; a single sample is its own average.
[[nodiscard]] double mean_over_time(std::span<const double> times, std::span<const double> values);

/// Value at a time [s], linear between samples. None outside the series: nothing is extrapolated.
[[nodiscard]] std::optional<double> value_at(std::span<const double> times,
                                             std::span<const double> values, double time);

/// Least-squares fit of ln y = ln y0 + rate t.
struct Growth {
  double rate = 0.0;       ///< [1/s]; > 0: the difference grows, 1/rate is its Lyapunov time
  double initial = 0.0;    ///< y0, fitted value at t = 0, in the unit of y
  double r_squared = 0.0;  ///< share of the variance of ln y that the fit explains [-]
  int num_samples = 0;     ///< samples in the interval
};

/// Exponential growth of a difference between begin and end [s], both included. None with fewer
/// than two samples there, or if one of them is not positive and finite: such a series is not
/// exponential.
[[nodiscard]] std::optional<Growth> growth_rate(std::span<const double> times,
                                                std::span<const double> values, double begin,
                                                double end);

}  // namespace weft::validation
