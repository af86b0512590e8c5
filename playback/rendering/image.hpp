#pragma once

// Tested by tests/playback/rendering/paint/png_test.cpp, tests/playback/rendering/paint/jpeg_test.cpp.

#include <filesystem>
#include <string>

#include <weft/scenes/appearance/image_file.hpp>
#include <weft/scenes/output/output_file.hpp>

namespace weft::scenes {

/// PNG bytes of an image.
[[nodiscard]] std::string encode_png(const Image& image);
/// JPEG bytes of an image: a fifth of the size, with loss. quality: 1 to 100. Throws InvalidArgument for another
/// one, and for an image that is none.
[[nodiscard]] std::string encode_jpeg(const Image& image, int quality = 82);
/// A PNG that encode_png() made.
extern const output::FileKind kPictureKind;
/// Follows the rule of output::OutputFile. Throws Error that names the file if it cannot be written;
/// nothing half-written stays behind.
void write_png(const std::filesystem::path& path, const Image& image);

}  // namespace weft::scenes
