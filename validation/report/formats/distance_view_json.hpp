#pragma once

// Tested by tests/validation/report/formats/quantized_test.cpp, tests/validation/report/json_test.cpp.

#include <nlohmann/json.hpp>

#include <weft/validation/report/distance_view.hpp>

namespace weft::validation {

/// As the page reads it; arrays of whole numbers and steps are base64 of 16-bit words, low byte first.
[[nodiscard]] nlohmann::ordered_json distance_view_json(const DistanceView& view);

}  // namespace weft::validation
