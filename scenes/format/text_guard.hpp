#pragma once

// Tested by tests/scenes/format/scene_file_test.cpp.

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace weft::scenes {

/// What is wrong with a text before it is even TOML.
struct TextDefect {
  int line = 1;
  int column = 1;
  std::string message;
};

/// Largest scene text that is read [bytes].
inline constexpr std::size_t kMaxTextSize = std::size_t{16} * 1024 * 1024;

/// Refuses what a TOML parser must not be given: too long, empty, not UTF-8, control characters,
/// brackets or dotted keys nested so deep that a recursive parser (or the destructor of its result)
/// could run out of stack.
[[nodiscard]] std::optional<TextDefect> find_text_defect(std::string_view text);

}  // namespace weft::scenes
