#pragma once

#include <vector>

#include <weft/core/types.hpp>

namespace weft::validation {

/// Counts of values in bins of equal width.
struct Histogram {
  double lower = 0.0;       ///< lower end of the first bin
  double upper = 0.0;       ///< upper end of the last bin
  std::vector<int> counts;  ///< bin k holds lower + k w <= value < lower + (k + 1) w
  int num_below = 0;        ///< values < lower
  int num_above = 0;        ///< values >= upper
};

/// Fixed bins, so that histograms of different engines and frames can be laid over each other.
struct HistogramBins {
  double lower = -0.5;
  double upper = 0.5;
  int num_bins = 50;
};

/// How far springs are stretched (> 0) or compressed (< 0); everything [-].
struct StrainStatistics {
  double minimum = 0.0;
  double percentile_5 = 0.0;
  double median = 0.0;
  double percentile_95 = 0.0;
  double percentile_99 = 0.0;
  double maximum = 0.0;
  double mean_absolute = 0.0;
  Histogram histogram;     ///< of the finite strains
  int num_non_finite = 0;  ///< if > 0, every number above is NaN
};

/// Spring strain (l - l0) / l0 of each edge. m [-].
/// Shapes   positions 3 x n [m], edges 2 x m, rest_lengths m [m], > 0
/// Errors   InvalidArgument for shapes that do not fit and for a rest length that is not > 0
[[nodiscard]] VectorX<double> edge_strains(ConstMatrix3XRef<double> positions, const Edges& edges,
                                           const VectorX<double>& rest_lengths);

/// Statistics of m >= 1 strains. Throws InvalidArgument for no strain and for bins without width.
[[nodiscard]] StrainStatistics strain_statistics(const VectorX<double>& strains,
                                                 const HistogramBins& bins = {});

}  // namespace weft::validation
