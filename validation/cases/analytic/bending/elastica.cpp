#include <weft/validation/cases/analytic/bending/elastica.hpp>

#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <Eigen/Core>

#include <weft/core/error.hpp>

namespace weft::validation {
namespace elastica {
namespace {

constexpr int kSteps = 4000;

/// phi = pi / 2 - theta, phi', height above the tip, distance from it; over the way from the tip.
using State = Eigen::Vector4d;

State slope(const State& y, double way, const ElasticaLoad& load) {
  const double sine = std::sin(y[0]);
  return {y[1], (load.gamma * way + load.tip_load) * sine, std::cos(y[0]), sine};
}

/// From a tip that hangs at this angle from the vertical; ends early where it passes the clamp's angle.
State shoot(double tip, double end, const ElasticaLoad& load) {
  State y(tip, 0, 0, 0);
  const double h = 1.0 / kSteps;
  for (int step = 0; step < kSteps; ++step) {
    const double way = step * h;
    const State k1 = slope(y, way, load);
    const State k2 = slope(y + h / 2 * k1, way + h / 2, load);
    const State k3 = slope(y + h / 2 * k2, way + h / 2, load);
    const State k4 = slope(y + h * k3, way + h, load);
    y += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
    if (y[0] > end && step + 1 < kSteps) break;
  }
  return y;
}

void check(const ElasticaLoad& load) {
  const auto require = [](const char* name, double value, double low, double high) {
    if (value >= low && value <= high) return;
    throw InvalidArgument(
        fmt::format("elastica: {} = {}, expected {} to {}", name, value, low, high));
  };
  require("gamma [1]", load.gamma, 0, 1e4);
  require("tip load [1]", load.tip_load, 0, 1e3);
  require("gamma + tip load [1]", load.gamma + load.tip_load, 1e-9, 1.1e4);
  require("tilt [rad]", load.tilt, -1.5, 1.5);
}

}  // namespace
}  // namespace elastica

HeavyElastica solve_elastica(const ElasticaLoad& load) {
  using namespace elastica;
  check(load);
  const double end = std::numbers::pi / 2 - load.tilt;
  // A long strip hangs straight but for its clamp: its tip's angle is found by its logarithm.
  double low = -300.0;
  double high = std::log(end);
  constexpr int kBisections = 80;
  for (int i = 0; i < kBisections && high - low > 1e-15; ++i) {
    const double middle = 0.5 * (low + high);
    (shoot(std::exp(middle), end, load)[0] > end ? high : low) = middle;
  }
  const double tip = std::exp(low);
  const State y = shoot(tip, end, load);
  return {y[2], y[3], y[1], std::numbers::pi / 2 - tip};
}

HeavyElastica solve_heavy_elastica(double gamma) {
  using namespace elastica;
  return solve_elastica({.gamma = gamma});
}

double gamma_of_chord(double angle) {
  using namespace elastica;
  const auto miss = [&](double log_gamma) {
    const HeavyElastica tip = solve_heavy_elastica(std::exp(log_gamma));
    return std::atan2(tip.drop, tip.reach) - angle;
  };
  double a = std::log(1e-3);
  double b = std::log(9e3);
  double at_a = miss(a);
  double at_b = miss(b);
  // Regula falsi, halving the end that stays (Illinois).
  constexpr int kMaxSteps = 60;
  constexpr double kClose = 1e-12;
  double middle = a;
  for (int i = 0; i < kMaxSteps; ++i) {
    middle = (a * at_b - b * at_a) / (at_b - at_a);
    const double at_middle = miss(middle);
    if (std::abs(at_middle) < kClose) break;
    if (at_middle * at_b < 0) {
      a = b;
      at_a = at_b;
    } else {
      at_a /= 2;
    }
    b = middle;
    at_b = at_middle;
  }
  return std::exp(middle);
}

}  // namespace weft::validation
