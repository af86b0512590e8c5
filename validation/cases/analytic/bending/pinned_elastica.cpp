#include <weft/validation/cases/analytic/bending/pinned_elastica.hpp>

#include <cmath>
#include <functional>
#include <string>

#include <Eigen/LU>

#include <weft/core/error.hpp>

namespace weft::validation {
namespace pinned_elastica {
namespace {

constexpr int kSteps = 1000;

/// theta, theta', integral of cos and of sin(theta) from the tip.
using State = Eigen::Vector4d;

State shoot(double tip, double force, double beta) {
  const auto slope = [&](const State& y) -> State {
    return {y[1], -force * std::sin(y[0] - beta), std::cos(y[0]), std::sin(y[0])};
  };
  State y(tip, 0, 0, 0);
  const double h = 1.0 / kSteps;
  for (int step = 0; step < kSteps; ++step) {
    const State k1 = slope(y);
    const State k2 = slope(y + h / 2 * k1);
    const State k3 = slope(y + h / 2 * k2);
    const State k4 = slope(y + h * k3);
    y += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
  }
  return y;
}

struct Solution {
  double force = 0.0;  ///< F
  double beta = 0.0;   ///< [rad], of F to the clamp's direction
  double reach = 0.0;
};

/// Newton for theta(0) = 0 and no sideways way, from a neighbor's solution.
Solution solve(double tip, Solution guess) {
  const auto miss = [&](double force, double beta) -> Eigen::Vector2d {
    const State y = shoot(tip, force, beta);
    return {y[0], y[3]};
  };
  constexpr int kMaxSteps = 30;
  for (int i = 0; i < kMaxSteps; ++i) {
    const Eigen::Vector2d now = miss(guess.force, guess.beta);
    constexpr double kForceStep = 1e-5;
    constexpr double kAngleStep = 1e-7;
    Eigen::Matrix2d slope;
    slope.col(0) = (miss(guess.force + kForceStep, guess.beta) - now) / kForceStep;
    slope.col(1) = (miss(guess.force, guess.beta + kAngleStep) - now) / kAngleStep;
    const Eigen::Vector2d change = slope.inverse() * now;
    guess.force -= change[0];
    guess.beta -= change[1];
    if (change.cwiseAbs().maxCoeff() < 1e-11) break;
  }
  guess.reach = shoot(tip, guess.force, guess.beta)[2];
  return guess;
}

PinnedElastica described(double tip, const Solution& solution) {
  return {1 - solution.reach, solution.force * std::cos(solution.beta),
          std::tan(std::abs(solution.beta)), tip};
}

/// Follows the first mode from a small angle of the tip until a growing quantity reaches its target.
PinnedElastica follow(double target, const std::function<double(const PinnedElastica&)>& quantity) {
  constexpr double kStep = 0.05;  // [rad]
  constexpr double kLastTip = 2.2;
  // Small angles: tan q = q for q^2 = F = 20.19, beta = 0.1785 of the tip's angle.
  Solution solution{20.1907, 0.1785 * kStep / 4, 0};
  double tip = kStep / 4;
  solution = solve(tip, solution);
  double low = tip;
  Solution at_low = solution;
  while (tip < kLastTip && quantity(described(tip, solution)) < target) {
    low = tip;
    at_low = solution;
    tip += kStep;
    solution.beta *= tip / low;
    solution = solve(tip, solution);
  }
  double high = tip;
  constexpr int kBisections = 40;
  for (int i = 0; i < kBisections && high - low > 1e-9; ++i) {
    const double middle = 0.5 * (low + high);
    solution = solve(middle, at_low);
    (quantity(described(middle, solution)) < target ? low : high) = middle;
  }
  return described(high, solve(high, at_low));
}

void require(const char* name, double value, double largest) {
  if (value > 0 && value <= largest) return;
  throw InvalidArgument("pinned elastica: " + std::string(name) + " = " + std::to_string(value) +
                        " [1], expected > 0 and <= " + std::to_string(largest));
}

}  // namespace
}  // namespace pinned_elastica

PinnedElastica pinned_elastica_of_ratio(double ratio) {
  using namespace pinned_elastica;
  require("ratio", ratio, 0.5);
  return follow(ratio, [](const PinnedElastica& e) { return e.ratio; });
}

PinnedElastica pinned_elastica_of_compression(double compression) {
  using namespace pinned_elastica;
  require("compression", compression, 0.45);
  return follow(compression, [](const PinnedElastica& e) { return e.compression; });
}

}  // namespace weft::validation
