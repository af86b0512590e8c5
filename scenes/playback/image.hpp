#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace weft::scenes {

/// 8-bit RGB picture, rows from top to bottom.
struct Image {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgb;  ///< 3 * width * height
};

/// PNG bytes of an image; metadata is stored as tEXt chunks ("Comment").
[[nodiscard]] std::string encode_png(const Image& image);
/// Throws Error that names the file if it cannot be written; nothing half-written stays behind.
void write_png(const std::filesystem::path& path, const Image& image);

}  // namespace weft::scenes
