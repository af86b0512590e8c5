#pragma once

// Tested by tests/validation/report/json_test.cpp.

#include <nlohmann/json.hpp>
#include <string>

namespace weft::validation {

/// Raised whenever a field changes its name or meaning; web/src/report.ts names the version it reads.
inline constexpr int kReportSchemaVersion = 3;

/// Pretty-prints JSON with two spaces, but keeps an array of numbers or words on one line: a plot
/// with a thousand points is four lines, not four thousand. Doubles get as many digits (up to 17)
/// as give back the same bits; bytes that are not UTF-8 become U+FFFD.
[[nodiscard]] std::string json_text(const nlohmann::ordered_json& value);

}  // namespace weft::validation
