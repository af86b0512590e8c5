#include "tests/contract/measurement.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/core.h>

namespace weft::contract {
namespace {

double ratio(const Measurement& m) {
  if (!m.holds()) return std::numeric_limits<double>::infinity();
  return m.allowed > 0 ? m.measured / m.allowed : 0.0;
}

double fitted_slope(const std::vector<double>& steps, const std::vector<double>& errors) {
  double sum_x = 0, sum_y = 0, sum_xx = 0, sum_xy = 0;
  const auto n = static_cast<double>(steps.size());
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const double x = std::log(steps[i]);
    const double y = std::log(errors[i]);
    sum_x += x;
    sum_y += y;
    sum_xx += x * x;
    sum_xy += x * y;
  }
  return (n * sum_xy - sum_x * sum_y) / (n * sum_xx - sum_x * sum_x);
}

}  // namespace

Measurement worse(const Measurement& a, const Measurement& b) {
  return ratio(b) > ratio(a) ? b : a;
}

testing::AssertionResult holds(const Measurement& m) {
  const std::string text =
      fmt::format("{}: measured {:.3g}, allowed {:.3g}, ratio {:.3g}", m.what, m.measured,
                  m.allowed, m.allowed > 0 ? m.measured / m.allowed : 0.0);
  return m.holds() ? testing::AssertionSuccess() << text : testing::AssertionFailure() << text;
}

Measurement order_of_convergence(const std::string& what, double order,
                                 const std::vector<double>& steps,
                                 const std::vector<double>& errors,
                                 const std::vector<double>& floors) {
  double largest = 0.0;
  std::vector<double> fitted_steps, fitted_errors;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    if (!std::isfinite(errors[i])) return {errors[i], 0.0, what};
    if (errors[i] > 0) largest = std::max(largest, errors[i] / floors[i]);
    if (!(errors[i] > floors[i])) continue;
    fitted_steps.push_back(steps[i]);
    fitted_errors.push_back(errors[i]);
  }
  if (largest <= 1.0) return {largest, 1.0, what + ", error over round-off (exact formula)"};
  if (fitted_steps.size() < 2) return {largest, 1.0, what + ", error over round-off (no order)"};
  const double slope = fitted_slope(fitted_steps, fitted_errors);
  return {std::abs(slope - order), kOrderMargin,
          fmt::format("{}, |order - {}|, fitted {:.3f}, errors {:.2g} to {:.2g}", what, order,
                      slope, errors.front(), errors.back())};
}

}  // namespace weft::contract
