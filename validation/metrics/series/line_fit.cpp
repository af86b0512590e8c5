#include <weft/validation/metrics/series/line_fit.hpp>

#include <cmath>
#include <numeric>

#include <fmt/core.h>

#include <weft/core/error.hpp>

namespace weft::validation {

std::optional<LineFit> fit_line(std::span<const double> x, std::span<const double> y) {
  if (x.size() != y.size()) {
    throw InvalidArgument(
        fmt::format("line fit: x = {}, y = {} values, expected the same", x.size(), y.size()));
  }
  if (x.size() < 2) return std::nullopt;
  const auto n = static_cast<double>(x.size());
  const double mean_x = std::accumulate(x.begin(), x.end(), 0.0) / n;
  const double mean_y = std::accumulate(y.begin(), y.end(), 0.0) / n;
  double xx = 0.0;
  double xy = 0.0;
  double yy = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    xx += (x[i] - mean_x) * (x[i] - mean_x);
    xy += (x[i] - mean_x) * (y[i] - mean_y);
    yy += (y[i] - mean_y) * (y[i] - mean_y);
  }
  if (!std::isfinite(xx) || !std::isfinite(xy) || !std::isfinite(yy) || xx == 0) {
    return std::nullopt;
  }
  const double slope = xy / xx;
  return LineFit{slope, mean_y - slope * mean_x, yy == 0 ? 1.0 : xy * xy / (xx * yy)};
}

}  // namespace weft::validation
