#include <png.h>

#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include <weft/core/error.hpp>
#include <weft/playback/rendering/image.hpp>

namespace weft::scenes {
namespace {

/// In every picture, and what it is known by.
constexpr const char* kComment = "Rendered by Weft";

bool begins_as_picture(std::string_view beginning) {
  return beginning.starts_with("\x89PNG\r\n\x1a\n") &&
         beginning.find(kComment) != std::string_view::npos;
}

void append_bytes(png_structp png, png_bytep bytes, png_size_t size) {
  static_cast<std::string*>(png_get_io_ptr(png))->append(reinterpret_cast<char*>(bytes), size);
}

void flush_nothing(png_structp) {}

[[noreturn]] void throw_png_error(png_structp, png_const_charp message) {
  throw Error(fmt::format("encode_png: libpng reports '{}'", message));
}

void ignore_warning(png_structp, png_const_charp) {}

/// Owns libpng's two structs, so that an exception on the way leaves nothing behind.
struct PngWriter {
  png_structp png =
      png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, throw_png_error, ignore_warning);
  png_infop info = png == nullptr ? nullptr : png_create_info_struct(png);
  PngWriter() = default;
  PngWriter(const PngWriter&) = delete;
  PngWriter& operator=(const PngWriter&) = delete;
  ~PngWriter() { png_destroy_write_struct(&png, &info); }
};

void check_image(const Image& image) {
  const std::size_t expected = image.width > 0 && image.height > 0
                                   ? std::size_t{3} * static_cast<std::size_t>(image.width) *
                                         static_cast<std::size_t>(image.height)
                                   : 0;
  if (expected == 0 || image.rgb.size() != expected) {
    throw InvalidArgument(
        fmt::format("encode_png: image = {} x {} pixels with {} bytes, expected width, height >= 1 "
                    "and {} bytes",
                    image.width, image.height, image.rgb.size(), expected));
  }
}

}  // namespace

const output::FileKind kPictureKind{"a picture", begins_as_picture};

std::string encode_png(const Image& image) {
  check_image(image);
  std::string bytes;
  PngWriter writer;
  if (writer.info == nullptr) throw Error("encode_png: libpng cannot be started");
  png_set_write_fn(writer.png, &bytes, append_bytes, flush_nothing);
  png_set_IHDR(writer.png, writer.info, static_cast<png_uint_32>(image.width),
               static_cast<png_uint_32>(image.height), 8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_sRGB(writer.png, writer.info, PNG_sRGB_INTENT_PERCEPTUAL);
  // No date and no program version: the same picture must give the same bytes.
  std::string key = "Comment";
  std::string comment = kComment;
  png_text text{};
  text.compression = PNG_TEXT_COMPRESSION_NONE;
  text.key = key.data();
  text.text = comment.data();
  text.text_length = comment.size();
  png_set_text(writer.png, writer.info, &text, 1);
  png_write_info(writer.png, writer.info);
  const std::size_t stride = std::size_t{3} * static_cast<std::size_t>(image.width);
  for (int row = 0; row < image.height; ++row) {
    png_write_row(writer.png, image.rgb.data() + stride * static_cast<std::size_t>(row));
  }
  png_write_end(writer.png, nullptr);
  return bytes;
}

void write_png(const std::filesystem::path& path, const Image& image) {
  output::write_file(path, kPictureKind, encode_png(image));
}

}  // namespace weft::scenes
