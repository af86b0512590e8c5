#pragma once

// Tested by tests/playback/rendering/renderer_test.cpp.

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace weft::scenes {

/// A file of this folder that is built into the library: a shader or the font.
struct Asset {
  std::string_view path;  ///< relative to playback/rendering
  const unsigned char* bytes;
  std::size_t size;
};

[[nodiscard]] std::span<const Asset> assets();

/// Throws Error for an unknown path.
[[nodiscard]] const Asset& find_asset(std::string_view path);
[[nodiscard]] std::string asset_text(std::string_view path);

}  // namespace weft::scenes
