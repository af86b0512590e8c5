#include <weft/validation/report/quantity_text.hpp>

#include <fmt/format.h>

namespace weft::validation {

std::string quantity_text(double value, const std::string& unit) {
  return unit.empty() || unit == "1" ? fmt::format("{:.6g}", value)
                                     : fmt::format("{:.6g} {}", value, unit);
}

std::string to_text(const ComparedValue& pair) {
  return fmt::format("{} {}, expected {}", pair.quantity, quantity_text(pair.value, pair.unit),
                     quantity_text(pair.expected, pair.unit));
}

}  // namespace weft::validation
