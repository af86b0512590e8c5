#pragma once

// Tested by tests/validation/metrics/distance/surface_distance_test.cpp.

#include <weft/core/types.hpp>

namespace weft::validation {

/// The value below which percent of the values lie, linear between ranks: rank = percent / 100
/// (n - 1) (type 7 of Hyndman and Fan 1996, the default of NumPy and R). NaN if a value is NaN or
/// there is none.
/// Errors   InvalidArgument unless 0 <= percent <= 100
[[nodiscard]] double percentile(const VectorX<double>& values, double percent);

}  // namespace weft::validation
