#pragma once

// Tested by tests/validation/report/junit_test.cpp.

#include <string>
#include <string_view>

namespace weft::validation {

/// Text for XML 1.0 content or a quoted attribute: markup is escaped; characters XML cannot hold
/// (most control characters, U+FFFE, U+FFFF) and bytes that are not UTF-8 become U+FFFD. Line
/// breaks and tabs survive in attributes.
[[nodiscard]] std::string xml_text(std::string_view text);

}  // namespace weft::validation
