#include <weft/validation/metrics/settling.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/core.h>

#include <weft/core/error.hpp>
#include <weft/validation/metrics/series/time_series.hpp>

namespace weft::validation {
namespace {

/// For each sample the first one from there on that is not below the threshold; values.size() if
/// there is none.
std::vector<std::size_t> next_above(std::span<const double> values, double threshold) {
  std::vector<std::size_t> next(values.size() + 1, values.size());
  for (std::size_t i = values.size(); i-- > 0;) {
    next[i] = values[i] < threshold ? next[i + 1] : i;  // a NaN is not below
  }
  return next;
}

}  // namespace

Settling settling(std::span<const double> times, std::span<const double> values,
                  const SettlingRule& rule) {
  check_series("settling", times, values);
  if (!(rule.threshold > 0) || !(rule.hold >= 0) || !std::isfinite(rule.hold)) {
    throw InvalidArgument(
        fmt::format("settling: threshold = {} [m^2/s^2], hold = {} [s], expected > 0 and >= 0",
                    rule.threshold, rule.hold));
  }
  // Sample times are sums of steps; a hold of 0.5 s is also reached at 0.49999999 s.
  const double hold = rule.hold * (1.0 - 1e-9);
  const std::vector<std::size_t> next = next_above(values, rule.threshold);
  Settling result;
  for (std::size_t i = 0; i < times.size() && !result.time; ++i) {
    if (next[i] == i) continue;
    if (times[next[i] - 1] - times[i] >= hold) {
      result.time = times[i];
      result.stays_settled = next[i] == times.size();
    }
  }
  for (std::size_t i = times.size(); i-- > 0 && times.back() - times[i] <= rule.hold;) {
    result.residual = std::isfinite(values[i]) && !std::isnan(result.residual)
                          ? std::max(result.residual, values[i])
                          : std::numeric_limits<double>::quiet_NaN();
  }
  return result;
}

double force_residual(ConstMatrix3XRef<double> forces, const VectorX<double>& masses,
                      const std::vector<int>& pinned, double gravity) {
  if (forces.cols() != masses.size()) {
    throw InvalidArgument(fmt::format("settling: forces = {} nodes, masses = {}, expected the same",
                                      forces.cols(), masses.size()));
  }
  if (!std::isfinite(gravity) || gravity <= 0) {
    throw InvalidArgument(
        fmt::format("settling: gravity = {} [m/s^2], expected > 0 and finite", gravity));
  }
  double largest = 0.0;
  for (Eigen::Index i = 0; i < forces.cols(); ++i) {
    if (!(masses[i] > 0)) {
      throw InvalidArgument(
          fmt::format("settling: mass of node {} = {} [kg], expected > 0", i, masses[i]));
    }
    if (std::binary_search(pinned.begin(), pinned.end(), static_cast<int>(i))) continue;
    if (!forces.col(i).allFinite()) return std::numeric_limits<double>::quiet_NaN();
    largest = std::max(largest, forces.col(i).norm() / (masses[i] * gravity));
  }
  return largest;
}

}  // namespace weft::validation
