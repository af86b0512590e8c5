#pragma once

#include <Eigen/Core>

#include <weft/scenes/appearance/appearance.hpp>

namespace weft::scenes {

/// Light of an sRGB colour, 0 to 1 per channel, where averages are physical.
[[nodiscard]] Eigen::Vector3f linear_light(const Rgb& color);
/// The inverse; values out of 0 to 1 are clamped.
[[nodiscard]] Rgb encode_srgb(const Eigen::Vector3f& light);

/// Perceptually uniform colours of a range of values: "viridis" for a range on one side of zero;
/// for a range that crosses zero a diverging map (blue, white, red) with white at zero, where equal
/// distances from zero look equally strong, even if the range is not symmetric.
class ColorMap {
 public:
  /// Throws InvalidArgument unless both are finite and minimum <= maximum.
  ColorMap(double minimum, double maximum);

  [[nodiscard]] double minimum() const { return minimum_; }
  [[nodiscard]] double maximum() const { return maximum_; }
  [[nodiscard]] bool is_diverging() const { return is_diverging_; }

  /// Values out of the range get the colour of its nearest end.
  [[nodiscard]] Rgb color(double value) const;

 private:
  double minimum_;
  double maximum_;
  bool is_diverging_;
};

/// What a value that is not finite is drawn with: no colour of either map.
inline constexpr Rgb kNoValueColor = {150, 150, 150};

}  // namespace weft::scenes
