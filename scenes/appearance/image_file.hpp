#pragma once

// Tested by tests/scenes/appearance/appearance_test.cpp.

#include <cstdint>
#include <string_view>
#include <vector>

namespace weft::scenes {

/// 8-bit sRGB picture, rows from top to bottom.
struct Image {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgb;  ///< 3 * width * height
};

inline constexpr int kMaxImageSize = 8192;  ///< of an image file, per axis [pixel]
/// The most pixels of an image file: 100 MB when it is decoded.
inline constexpr long long kMaxImagePixels = 33'554'432;

/// Whether a name ends as those of files that decode_image() reads: .png, .jpg, .jpeg.
[[nodiscard]] bool has_image_extension(std::string_view name);

/// Decodes a PNG or JPEG; what is transparent becomes white. Its size is checked before memory is
/// reserved for it. Throws Error without the file's name.
[[nodiscard]] Image decode_image(std::string_view bytes);

}  // namespace weft::scenes
