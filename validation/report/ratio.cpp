#include <cmath>
#include <limits>

#include <weft/validation/report/ratio.hpp>

namespace weft::validation {

std::optional<double> ratio(const CheckResult& check) {
  if (!check.tolerance) return std::nullopt;
  if (std::isnan(check.measured)) return check.measured;
  if (check.tolerance->value != 0.0) return check.measured / check.tolerance->value;
  return check.measured <= 0.0 ? 0.0 : std::numeric_limits<double>::infinity();
}

std::string_view ratio_flag(const CheckResult& check) {
  const std::optional<double> value = ratio(check);
  if (!value || check.verdict != Verdict::kPass || check.tolerance->basis == Basis::kExact) {
    return "";
  }
  if (*value > kTightRatio) return "tight";
  return *value < kLooseRatio ? "loose" : "";
}

}  // namespace weft::validation
