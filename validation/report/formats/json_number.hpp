#pragma once

// Tested by tests/validation/report/json_test.cpp.

#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

namespace weft::validation {

/// JSON has no word for NaN and the infinities; a string cannot be mistaken for a measured number.
[[nodiscard]] inline nlohmann::ordered_json json_number(double value) {
  if (std::isnan(value)) return "NaN";
  if (std::isinf(value)) return value > 0.0 ? "Infinity" : "-Infinity";
  return value;
}

[[nodiscard]] inline nlohmann::ordered_json json_numbers(const std::vector<double>& values) {
  nlohmann::ordered_json array = nlohmann::ordered_json::array();
  for (const double value : values) array.push_back(json_number(value));
  return array;
}

}  // namespace weft::validation
