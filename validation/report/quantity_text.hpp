#pragma once

// Tested by tests/validation/report/text_test.cpp.

#include <string>

#include <weft/validation/report/report.hpp>

namespace weft::validation {

/// "0.0539 m"; without a unit where it is "1" or empty. Six significant digits.
[[nodiscard]] std::string quantity_text(double value, const std::string& unit);

/// "drop of the tip 0.0541 m, expected 0.0539 m".
[[nodiscard]] std::string to_text(const ComparedValue& pair);

}  // namespace weft::validation
