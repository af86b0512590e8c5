#include <weft/validation/metrics/series/percentile.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/core.h>

#include <weft/core/error.hpp>

namespace weft::validation {

double percentile(const VectorX<double>& values, double percent) {
  if (!(percent >= 0 && percent <= 100)) {
    throw InvalidArgument(
        fmt::format("percentile: percent = {} [%], expected 0 <= percent <= 100", percent));
  }
  if (values.size() == 0 || values.hasNaN()) return std::numeric_limits<double>::quiet_NaN();
  VectorX<double> sorted = values;
  std::sort(sorted.begin(), sorted.end());
  const double rank = percent / 100.0 * static_cast<double>(sorted.size() - 1);
  const auto low = static_cast<Eigen::Index>(std::floor(rank));
  const Eigen::Index high = std::min(low + 1, sorted.size() - 1);
  // Equal ends are returned as they are: inf - inf would be NaN.
  if (sorted[low] == sorted[high]) return sorted[low];
  return sorted[low] + (rank - static_cast<double>(low)) * (sorted[high] - sorted[low]);
}

}  // namespace weft::validation
