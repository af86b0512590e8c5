#pragma once

#include <filesystem>
#include <string>

#include <weft/scenes/image_file.hpp>

namespace weft::scenes {

/// PNG bytes of an image.
[[nodiscard]] std::string encode_png(const Image& image);
/// Throws Error that names the file if it cannot be written; nothing half-written stays behind.
void write_png(const std::filesystem::path& path, const Image& image);

}  // namespace weft::scenes
