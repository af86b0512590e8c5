#include <weft/validation/metrics/series/tolerance.hpp>

#include <cmath>

namespace weft::validation {

std::string_view to_string(Basis basis) {
  switch (basis) {
    case Basis::kExact:
      return "exact";
    case Basis::kRoundoff:
      return "round-off";
    case Basis::kTruncation:
      return "truncation";
    case Basis::kModelGap:
      return "model gap";
    case Basis::kStatistical:
      return "statistical";
  }
  return "unknown";
}

Verdict judge(double measured, const Tolerance& tolerance) {
  // isfinite: an error of minus infinity would otherwise pass every bound.
  const bool ok = std::isfinite(measured) && measured <= tolerance.value;
  return ok ? Verdict::kPass : Verdict::kFail;
}

}  // namespace weft::validation
