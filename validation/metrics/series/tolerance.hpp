#pragma once

#include <string>
#include <string_view>

namespace weft::validation {

/// Why a bound has the value it has.
enum class Basis {
  kExact,        ///< equal bits, or a count
  kRoundoff,     ///< a multiple of machine epsilon times the size and number of operations
  kTruncation,   ///< C h^p with p tested
  kModelGap,     ///< two models differ; measured, both numbers stored
  kStatistical,  ///< spread over seeds
};

[[nodiscard]] std::string_view to_string(Basis basis);

/// An upper bound on a measured error, with its reason. A bare literal is not a tolerance.
struct Tolerance {
  double value = 0.0;  ///< in the unit of the metric it bounds
  Basis basis = Basis::kExact;
  std::string why;  ///< one sentence: where the value comes from
};

enum class Verdict {
  kPass,
  kFail,
  kInfo,  ///< measured and shown, not gated
  kKnown,  ///< fails, and is stated as a known deviation: shown as a failure, keeps no report from passing
  kStale,  ///< stated as a known deviation that does not occur any more, or is another one: fails
};

/// measured <= tolerance; a measured value that is not a number fails.
[[nodiscard]] Verdict judge(double measured, const Tolerance& tolerance);

}  // namespace weft::validation
