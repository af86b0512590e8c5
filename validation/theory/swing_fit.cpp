#include <weft/validation/theory/swing_fit.hpp>

#include <cmath>
#include <limits>
#include <optional>

#include <Eigen/Dense>

namespace weft::validation {

namespace {
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
}

SwingFit fit_swing(const std::vector<double>& values, double interval) {
  if (values.size() < 4) return {kNone, kNone};
  Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
  Eigen::Vector2d right = Eigen::Vector2d::Zero();
  for (std::size_t n = 1; n + 1 < values.size(); ++n) {
    const Eigen::Vector2d row(values[n], values[n - 1]);
    normal += row * row.transpose();
    right += values[n + 1] * row;
  }
  const Eigen::Vector2d factors = normal.fullPivLu().solve(right);
  // The roots of r^2 = a r + b: a swing has two conjugate ones of modulus sqrt(-b).
  const double square = -factors[1];
  if (!(square > 0)) return {kNone, kNone};
  const double modulus = std::sqrt(square);
  const double cosine = factors[0] / (2 * modulus);
  if (!(std::abs(cosine) < 1)) return {kNone, kNone};
  return {std::acos(cosine) / interval, -std::log(modulus) / interval};
}

double period_of(const std::vector<double>& values, double interval) {
  std::optional<double> first;
  double last = 0.0;
  int periods = 0;
  for (std::size_t n = 1; n < values.size(); ++n) {
    if (!(values[n - 1] < 0 && values[n] >= 0)) continue;
    const double share = values[n - 1] / (values[n - 1] - values[n]);
    last = (static_cast<double>(n - 1) + share) * interval;
    if (first) {
      ++periods;
    } else {
      first = last;
    }
  }
  return periods > 0 ? (last - *first) / periods : kNone;
}

}  // namespace weft::validation
