#pragma once

// Tested by tests/validation/report/formats/quantized_test.cpp.

#include <string>
#include <string_view>

namespace weft::validation {

/// Base64 of RFC 4648 section 4, with padding, on one line.
[[nodiscard]] std::string to_base64(std::string_view bytes);

}  // namespace weft::validation
