#include <weft/scenes/recording/rounding.hpp>

#include <cmath>

#include <fmt/core.h>

#include <weft/core/error.hpp>

namespace weft::scenes {
namespace {

/// Largest power of two of which half is within the bound.
double rounding_step(double bound) {
  return std::exp2(std::floor(std::log2(2.0 * bound)));
}

/// Multiples of a power of two are exact in either precision, as the value itself was.
double rounded_to(double value, double step) {
  return std::isfinite(value) ? step * std::nearbyint(value / step) : value;
}

}  // namespace

RoundingBounds rounding_bounds(double position, double frame_interval) {
  const auto check = [](const char* name, double value, const char* unit) {
    if (value > 0.0 && std::isfinite(value)) return;
    throw InvalidArgument(
        fmt::format("rounding: {} = {} [{}], expected > 0 and finite", name, value, unit));
  };
  check("position error", position, "m");
  check("frame interval", frame_interval, "s");
  return {position, position / frame_interval};
}

void round_state(SceneState& state, const RoundingBounds& bounds) {
  const double length = rounding_step(bounds.position);
  const double speed = rounding_step(bounds.velocity);
  const auto round_all = [](auto& values, double step) {
    values = values.unaryExpr([step](double value) { return rounded_to(value, step); }).eval();
  };
  for (ClothState& cloth : state.cloths) {
    round_all(cloth.positions, length);
    round_all(cloth.velocities, speed);
  }
  for (RigidState& rigid : state.rigids) {
    round_all(rigid.position, length);
    round_all(rigid.velocity, speed);
  }
}

std::string rounding_text(const RoundingBounds& bounds) {
  return fmt::format("positions by at most {:.6g} m, velocities by at most {:.6g} m/s",
                     bounds.position, bounds.velocity);
}

}  // namespace weft::scenes
