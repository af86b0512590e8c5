#pragma once

// Tested by tests/scenes/format/scene_file_test.cpp.

#include <string>
#include <string_view>

namespace weft::scenes {

/// TOML number that reads back to the same bits: a decimal point or exponent keeps it a float.
[[nodiscard]] std::string toml_number(double value);

/// Quoted text.
[[nodiscard]] std::string toml_string(std::string_view text);

}  // namespace weft::scenes
