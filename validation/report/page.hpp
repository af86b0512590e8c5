#pragma once

// Tested by tests/validation/report/html_test.cpp.

#include <string_view>

namespace weft::validation {

/// The report page before it has data: the bytes of web/dist/report.html.
[[nodiscard]] std::string_view page_template();

}  // namespace weft::validation
