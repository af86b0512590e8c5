#pragma once

#include <span>
#include <string>

namespace weft::validation {

/// Numbers in 65535 equal steps from lowest to highest, for pictures on the page: off by at most half
/// a step. Measured values never go through this.
struct Quantized {
  double lowest = 0.0;
  double highest = 0.0;
  /// 2 per number, low byte first: 0 is lowest, 65534 is highest, 65535 stands for a number that was
  /// not finite.
  std::string bytes;
};

/// The range is that of the finite values; without any it is 0 to 0.
[[nodiscard]] Quantized quantize(std::span<const double> values);

/// With a range of the caller's; finite values outside it take its nearer end.
/// @throws InvalidArgument unless lowest <= highest, both finite.
[[nodiscard]] Quantized quantize(std::span<const double> values, double lowest, double highest);

}  // namespace weft::validation
