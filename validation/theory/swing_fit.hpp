#pragma once

#include <vector>

namespace weft::validation {

/// A swing about 0, sampled at equal times.
struct SwingFit {
  double frequency = 0.0;  ///< w [rad/s]; NaN where the values do not swing
  double decay = 0.0;      ///< of the amplitude [1/s], negative if it grows; NaN likewise
};

/// Least-squares fit of x(n + 1) = a x(n) + b x(n - 1), which e^(-decay t) cos(w t + phase) fulfils exactly, so that the
/// result does not depend on how often it was sampled, as long as w interval < pi.
/// Units   values any; interval between them [s], > 0. NaN for fewer than four values.
[[nodiscard]] SwingFit fit_swing(const std::vector<double>& values, double interval);

/// Mean period of a swing about 0 of any size [s]: from the first to the last time at which it passes 0 upwards, each found
/// between two samples by a line; NaN if it does so less than twice. Units as above.
[[nodiscard]] double period_of(const std::vector<double>& values, double interval);

}  // namespace weft::validation
