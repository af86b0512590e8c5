#pragma once

// Tested by tests/validation/report/report_test.cpp.

#include <optional>
#include <string_view>

#include <weft/validation/report/report.hpp>

namespace weft::validation {

/// A bound that says little: above this ratio it leaves no room ...
inline constexpr double kTightRatio = 0.5;
/// ... and below this one it would let a large error through.
inline constexpr double kLooseRatio = 0.01;

/// measured / allowed [1]; none if the row is not gated. A zero bound gives 0 if it is met and
/// infinity if not; a measured value that is not a number gives NaN.
[[nodiscard]] std::optional<double> ratio(const CheckResult& check);

/// "tight", "loose" or "". Bounds on exact quantities (equal bits, counts) are never flagged, nor
/// are failed checks.
[[nodiscard]] std::string_view ratio_flag(const CheckResult& check);

}  // namespace weft::validation
