#pragma once

// Tested by tests/scenes/import/import_test.cpp.

#include <optional>
#include <string>
#include <string_view>

namespace weft::import {

/// What is wrong with the header of a PLY file, in one line; none if nothing is. assimp 5.2 searches
/// without end where a header does not end, and reserves memory for as many elements as it names.
[[nodiscard]] std::optional<std::string> ply_header_fault(std::string_view bytes);

}  // namespace weft::import
