#include <algorithm>
#include <cmath>
#include <cstdint>

#include <weft/core/error.hpp>
#include <weft/validation/report/formats/quantized.hpp>

namespace weft::validation {
namespace {

constexpr std::uint32_t kHighest = 65534;
constexpr std::uint32_t kNotFinite = 65535;

std::uint32_t step_of(double value, double lowest, double highest) {
  if (!std::isfinite(value)) return kNotFinite;
  if (highest <= lowest) return 0;
  const double share = std::clamp((value - lowest) / (highest - lowest), 0.0, 1.0);
  return static_cast<std::uint32_t>(std::lround(share * kHighest));
}

}  // namespace

Quantized quantize(std::span<const double> values) {
  double lowest = 0.0;
  double highest = 0.0;
  bool any = false;
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    lowest = any ? std::min(lowest, value) : value;
    highest = any ? std::max(highest, value) : value;
    any = true;
  }
  return quantize(values, lowest, highest);
}

Quantized quantize(std::span<const double> values, double lowest, double highest) {
  if (!std::isfinite(lowest) || !std::isfinite(highest) || lowest > highest) {
    throw InvalidArgument("quantize: the range must be finite and not empty");
  }
  Quantized result{lowest, highest, {}};
  result.bytes.reserve(2 * values.size());
  for (const double value : values) {
    const std::uint32_t step = step_of(value, lowest, highest);
    result.bytes += static_cast<char>(step & 0xFFU);
    result.bytes += static_cast<char>(step >> 8U);
  }
  return result;
}

}  // namespace weft::validation
