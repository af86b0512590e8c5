#pragma once

// Tested by tests/scenes/format/scene_file_test.cpp.

#include <string>

#include <weft/scenes/shapes/shapes.hpp>

namespace weft::scenes {

/// "key = value" lines of the keys shape, radius, size and so on. Throws InvalidArgument for a
/// value that is not finite.
[[nodiscard]] std::string shape_text(const Shape& shape);

}  // namespace weft::scenes
