#pragma once

// Tested by tests/scenes/format/scene_file_test.cpp.

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace weft::scenes {

/// ", did you mean 'radius'?" if one of the candidates is close to name, else ", expected one of a,
/// b, c".
[[nodiscard]] std::string suggestion(std::string_view name,
                                     std::span<const std::string_view> candidates);

/// text for a one-line message: control characters escaped, cut after max_length bytes (at a whole
/// character).
[[nodiscard]] std::string shown(std::string_view text, std::size_t max_length = 60);

}  // namespace weft::scenes
