#include <weft/validation/cases/elastica.hpp>

#include <cmath>
#include <string>

#include <Eigen/Core>

#include <weft/custom_forces/core/error.hpp>

namespace weft::validation {
namespace {

constexpr int kSteps = 4000;
constexpr double kMaxGamma = 200.0;  // shooting forward loses exp(sqrt(2 gamma)) of its digits

/// theta, theta', drop, reach
using State = Eigen::Vector4d;

State slope(const State& y, double s, double gamma) {
  return {y[1], -gamma * (1 - s) * std::cos(y[0]), std::sin(y[0]), std::cos(y[0])};
}

State shoot(double curvature, double gamma) {
  State y(0, curvature, 0, 0);
  const double h = 1.0 / kSteps;
  for (int step = 0; step < kSteps; ++step) {
    const double s = step * h;
    const State k1 = slope(y, s, gamma);
    const State k2 = slope(y + h / 2 * k1, s + h / 2, gamma);
    const State k3 = slope(y + h / 2 * k2, s + h / 2, gamma);
    const State k4 = slope(y + h * k3, s + h, gamma);
    y += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
    // Past the vertical the curvature cannot come back to 0: too much at the clamp.
    if (y[0] > 1.6) return State(y[0], 1.0, 0, 0);
    if (y[1] < 0) return State(y[0], -1.0, 0, 0);
  }
  return y;
}

}  // namespace

HeavyElastica solve_heavy_elastica(double gamma) {
  if (!(gamma > 0 && gamma <= kMaxGamma)) {
    throw InvalidArgument("heavy elastica: gamma = " + std::to_string(gamma) +
                          " [1], expected > 0 and <= " + std::to_string(kMaxGamma));
  }
  double low = 0.0;
  double high = 1.0 + gamma;
  constexpr int kBisections = 200;  // until the numbers meet
  for (int i = 0; i < kBisections && high - low > 1e-16 * high; ++i) {
    const double middle = 0.5 * (low + high);
    (shoot(middle, gamma)[1] > 0 ? high : low) = middle;
  }
  // The last step may have ended either way: take the drop from a curvature that reaches the tip.
  State y(0, 1, 0, 0);
  double curvature = high;
  for (double candidate : {low, 0.5 * (low + high), high}) {
    const State end = shoot(candidate, gamma);
    if (end[3] > 0 && std::abs(end[1]) < std::abs(y[1])) {
      y = end;
      curvature = candidate;
    }
  }
  return {y[2], y[3], curvature};
}

}  // namespace weft::validation
