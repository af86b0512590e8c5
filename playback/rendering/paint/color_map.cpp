#include <weft/playback/rendering/paint/color_map.hpp>

#include <algorithm>
#include <cmath>
#include <span>

#include <fmt/format.h>

#include <weft/core/error.hpp>

namespace weft::scenes {
namespace {

/// "viridis" by N. J. Smith, S. van der Walt and E. Firing (CC0), every 16th of its 256 colours.
/// Linear interpolation is within 2/255 of the full table.
constexpr std::array<Rgb, 17> kViridis = {{{68, 1, 84},
                                           {72, 24, 106},
                                           {71, 45, 123},
                                           {66, 64, 134},
                                           {59, 82, 139},
                                           {51, 99, 141},
                                           {44, 114, 142},
                                           {38, 130, 142},
                                           {33, 145, 140},
                                           {31, 159, 136},
                                           {39, 173, 129},
                                           {61, 188, 116},
                                           {92, 200, 99},
                                           {129, 211, 77},
                                           {170, 220, 50},
                                           {213, 226, 26},
                                           {253, 231, 37}}};

/// Straight lines in CIELAB from a blue (L* = 33) and a red (L* = 37) to a warm white (L* = 94).
constexpr std::array<Rgb, 17> kDiverging = {{{33, 75, 150},
                                             {69, 93, 161},
                                             {96, 112, 171},
                                             {122, 132, 182},
                                             {146, 152, 193},
                                             {169, 173, 203},
                                             {193, 195, 214},
                                             {216, 217, 224},
                                             {240, 239, 235},
                                             {235, 215, 208},
                                             {228, 190, 182},
                                             {221, 166, 156},
                                             {212, 142, 131},
                                             {202, 119, 107},
                                             {191, 94, 84},
                                             {178, 69, 61},
                                             {165, 40, 40}}};

/// The tables are dense enough that mixing sRGB values, not light, keeps them uniform.
Rgb mix(std::span<const Rgb> table, double place) {
  const double x = std::clamp(place, 0.0, 1.0) * static_cast<double>(table.size() - 1);
  const auto left = std::min(static_cast<std::size_t>(x), table.size() - 2);
  const double part = x - static_cast<double>(left);
  Rgb result{};
  for (std::size_t c = 0; c < 3; ++c) {
    const double value = (1.0 - part) * table[left][c] + part * table[left + 1][c];
    result[c] = static_cast<std::uint8_t>(std::lround(value));
  }
  return result;
}

}  // namespace

Eigen::Vector3f linear_light(const Rgb& color) {
  Eigen::Vector3f light;
  for (int c = 0; c < 3; ++c) {
    const float value = static_cast<float>(color[static_cast<std::size_t>(c)]) / 255.0f;
    light[c] = value <= 0.04045f ? value / 12.92f : std::pow((value + 0.055f) / 1.055f, 2.4f);
  }
  return light;
}

Rgb encode_srgb(const Eigen::Vector3f& light) {
  Rgb color{};
  for (int c = 0; c < 3; ++c) {
    const float value = std::clamp(light[c], 0.0f, 1.0f);
    const float encoded =
        value <= 0.0031308f ? 12.92f * value : 1.055f * std::pow(value, 1.0f / 2.4f) - 0.055f;
    color[static_cast<std::size_t>(c)] = static_cast<std::uint8_t>(std::lround(255.0f * encoded));
  }
  return color;
}

ColorMap::ColorMap(double minimum, double maximum)
    : minimum_(minimum), maximum_(maximum), is_diverging_(minimum < 0.0 && maximum > 0.0) {
  if (!std::isfinite(minimum) || !std::isfinite(maximum) || minimum > maximum) {
    throw InvalidArgument(
        fmt::format("ScalarField: range = {} to {}, expected finite numbers, minimum <= maximum",
                    minimum, maximum));
  }
}

Rgb ColorMap::color(double value) const {
  if (!std::isfinite(value)) return kNoValueColor;
  const double clamped = std::clamp(value, minimum_, maximum_);
  if (is_diverging_) {
    const double strongest = std::max(-minimum_, maximum_);
    return mix(kDiverging, 0.5 + 0.5 * clamped / strongest);
  }
  const double width = maximum_ - minimum_;
  return mix(kViridis, width > 0.0 ? (clamped - minimum_) / width : 0.0);
}

}  // namespace weft::scenes
