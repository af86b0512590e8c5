#include <weft/validation/metrics/strain.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/core.h>

#include <weft/core/error.hpp>
#include <weft/mesh/cloth_mesh.hpp>
#include <weft/validation/metrics/series/percentile.hpp>

namespace weft::validation {
namespace {

void check(ConstMatrix3XRef<double> positions, const Edges& edges,
           const VectorX<double>& rest_lengths) {
  if (rest_lengths.size() != edges.cols()) {
    throw InvalidArgument(fmt::format("strain: rest_lengths = {} values, expected {}",
                                      rest_lengths.size(), edges.cols()));
  }
  if (edges.cols() == 0) return;
  if (edges.minCoeff() < 0 || edges.maxCoeff() >= positions.cols()) {
    throw InvalidArgument(fmt::format("strain: edge ends = {} to {}, expected node indices 0 to {}",
                                      edges.minCoeff(), edges.maxCoeff(), positions.cols() - 1));
  }
  for (const double length : rest_lengths) {
    if (!std::isfinite(length) || length <= 0) {
      throw InvalidArgument(
          fmt::format("strain: rest_length = {} [m], expected > 0 and finite", length));
    }
  }
}

void add(Histogram& histogram, double value) {
  if (value < histogram.lower) {
    ++histogram.num_below;
  } else if (value >= histogram.upper) {
    ++histogram.num_above;
  } else {
    const double width = histogram.upper - histogram.lower;
    const double place =
        (value - histogram.lower) / width * static_cast<double>(histogram.counts.size());
    // Rounding can put a value just below upper one bin too far.
    const auto bin = std::min(static_cast<std::size_t>(place), histogram.counts.size() - 1);
    ++histogram.counts[bin];
  }
}

}  // namespace

VectorX<double> edge_strains(ConstMatrix3XRef<double> positions, const Edges& edges,
                             const VectorX<double>& rest_lengths) {
  check(positions, edges, rest_lengths);
  return edge_lengths(positions, edges).cwiseQuotient(rest_lengths).array() - 1.0;
}

StrainStatistics strain_statistics(const VectorX<double>& strains, const HistogramBins& bins) {
  if (strains.size() == 0) throw InvalidArgument("strain: strains = 0 values, expected >= 1");
  if (bins.num_bins < 1 || !std::isfinite(bins.lower) || !std::isfinite(bins.upper) ||
      bins.lower >= bins.upper) {
    throw InvalidArgument(
        fmt::format("strain: bins = {} from {} to {} [-], expected >= 1 of positive width",
                    bins.num_bins, bins.lower, bins.upper));
  }
  StrainStatistics result;
  result.histogram = {bins.lower, bins.upper,
                      std::vector<int>(static_cast<std::size_t>(bins.num_bins), 0), 0, 0};
  for (const double strain : strains) {
    if (std::isfinite(strain)) {
      add(result.histogram, strain);
    } else {
      ++result.num_non_finite;
    }
  }
  // Percentiles of a NaN are NaN; an infinite strain must not hide behind a finite median either.
  const VectorX<double> usable =
      result.num_non_finite == 0
          ? strains
          : VectorX<double>::Constant(1, std::numeric_limits<double>::quiet_NaN());
  result.minimum = percentile(usable, 0);
  result.percentile_5 = percentile(usable, 5);
  result.median = percentile(usable, 50);
  result.percentile_95 = percentile(usable, 95);
  result.percentile_99 = percentile(usable, 99);
  result.maximum = percentile(usable, 100);
  result.mean_absolute = usable.cwiseAbs().mean();
  return result;
}

}  // namespace weft::validation
