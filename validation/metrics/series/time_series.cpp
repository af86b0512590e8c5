#include <weft/validation/metrics/series/time_series.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <fmt/core.h>

#include <weft/core/error.hpp>
#include <weft/validation/metrics/series/line_fit.hpp>

namespace weft::validation {

void check_series(std::string_view where, std::span<const double> times,
                  std::span<const double> values) {
  if (times.size() != values.size() || times.empty()) {
    throw InvalidArgument(fmt::format("{}: times = {}, values = {}, expected the same number >= 1",
                                      where, times.size(), values.size()));
  }
  for (std::size_t i = 0; i < times.size(); ++i) {
    if (!std::isfinite(times[i]) || (i > 0 && times[i] <= times[i - 1])) {
      throw InvalidArgument(
          fmt::format("{}: time {} = {} [s], expected finite and strictly increasing times", where,
                      i, times[i]));
    }
  }
}

Extreme largest_over_time(std::span<const double> times, std::span<const double> values) {
  check_series("time series", times, values);
  Extreme result{times[0], values[0]};
  for (std::size_t i = 0; i < times.size(); ++i) {
    if (!std::isfinite(values[i])) return {times[i], std::numeric_limits<double>::quiet_NaN()};
    if (values[i] > result.value) result = {times[i], values[i]};
  }
  return result;
}

double mean_over_time(std::span<const double> times, std::span<const double> values) {
  check_series("time series", times, values);
  for (const double value : values) {
    if (!std::isfinite(value)) return std::numeric_limits<double>::quiet_NaN();
  }
  if (times.size() == 1) return values[0];
  double integral = 0.0;
  for (std::size_t i = 1; i < times.size(); ++i) {
    integral += 0.5 * (values[i] + values[i - 1]) * (times[i] - times[i - 1]);
  }
  return integral / (times.back() - times.front());
}

std::optional<double> value_at(std::span<const double> times, std::span<const double> values,
                               double time) {
  check_series("time series", times, values);
  if (!(time >= times.front() && time <= times.back())) return std::nullopt;
  const auto after = std::lower_bound(times.begin(), times.end(), time);
  const auto i = static_cast<std::size_t>(after - times.begin());
  double value = values[i];
  if (times[i] != time) {
    const double share = (time - times[i - 1]) / (times[i] - times[i - 1]);
    value = values[i - 1] + share * (values[i] - values[i - 1]);
  }
  return std::isfinite(value) ? value : std::numeric_limits<double>::quiet_NaN();
}

std::optional<Growth> growth_rate(std::span<const double> times, std::span<const double> values,
                                  double begin, double end) {
  check_series("growth rate", times, values);
  std::vector<double> x;
  std::vector<double> log_y;
  for (std::size_t i = 0; i < times.size(); ++i) {
    if (times[i] < begin || times[i] > end) continue;
    if (!std::isfinite(values[i]) || values[i] <= 0) return std::nullopt;
    x.push_back(times[i]);
    log_y.push_back(std::log(values[i]));
  }
  const std::optional<LineFit> fit = fit_line(x, log_y);
  if (!fit) return std::nullopt;
  return Growth{fit->slope, std::exp(fit->intercept), fit->r_squared, static_cast<int>(x.size())};
}

}  // namespace weft::validation
