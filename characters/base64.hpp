#pragma once

// Tested by tests/characters/gltf_faults_test.cpp, tests/characters/skinning_test.cpp.

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace weft::characters {

/// RFC 4648 with padding. Decoding gives none for a text that is no such one.
[[nodiscard]] std::string to_base64(std::span<const std::byte> bytes);
[[nodiscard]] std::optional<std::vector<std::byte>> from_base64(std::string_view text);

}  // namespace weft::characters
