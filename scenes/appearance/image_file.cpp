#include <weft/scenes/appearance/image_file.hpp>

#include <cctype>
#include <memory>
#include <string>

#include <fmt/format.h>
#include <png.h>
#include <turbojpeg.h>

#include <weft/core/error.hpp>

namespace weft::scenes {
namespace {

constexpr int kMaxScans = 64;

Image make_image(long long width, long long height) {
  if (width < 1 || height < 1 || width > kMaxImageSize || height > kMaxImageSize) {
    throw Error(fmt::format("has {} x {} pixels, expected at most {} x {}", width, height,
                            kMaxImageSize, kMaxImageSize));
  }
  if (width * height > kMaxImagePixels) {
    throw Error(fmt::format("has {} x {} pixels, expected at most {} in all", width, height,
                            kMaxImagePixels));
  }
  Image image{static_cast<int>(width), static_cast<int>(height), {}};
  image.rgb.resize(static_cast<std::size_t>(3 * width * height));
  return image;
}

/// A progressive JPEG may go over all its pixels once more for every few bytes of the file. Encoders
/// write about ten scans.
void check_scans(std::string_view bytes) {
  constexpr std::string_view kStartOfScan = "\xff\xda";
  int num_scans = 0;
  for (std::size_t at = bytes.find(kStartOfScan); at != std::string_view::npos;
       at = bytes.find(kStartOfScan, at + 1)) {
    if (++num_scans > kMaxScans) {
      throw Error(fmt::format("has over {} scans, expected an ordinary JPEG", kMaxScans));
    }
  }
}

Image decode_png(std::string_view bytes) {
  struct FreePng {
    void operator()(png_image* png) const { png_image_free(png); }
  };
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  const std::unique_ptr<png_image, FreePng> guard(&png);
  if (png_image_begin_read_from_memory(&png, bytes.data(), bytes.size()) == 0) {
    throw Error(fmt::format("is no readable PNG: {}", png.message));
  }
  Image image = make_image(png.width, png.height);
  png.format = PNG_FORMAT_RGB;
  const png_color white{255, 255, 255};
  if (png_image_finish_read(&png, &white, image.rgb.data(), 0, nullptr) == 0) {
    throw Error(fmt::format("is no readable PNG: {}", png.message));
  }
  return image;
}

Image decode_jpeg(std::string_view bytes) {
  struct Destroy {
    void operator()(void* handle) const { tjDestroy(handle); }
  };
  const std::unique_ptr<void, Destroy> handle(tjInitDecompress());
  if (!handle) throw Error("cannot be decoded: out of memory");
  const auto* data = reinterpret_cast<const unsigned char*>(bytes.data());
  int width = 0;
  int height = 0;
  int subsampling = 0;
  int color_space = 0;
  if (tjDecompressHeader3(handle.get(), data, bytes.size(), &width, &height, &subsampling,
                          &color_space) != 0 ||
      width < 1 || height < 1) {
    throw Error(fmt::format("is no readable JPEG: {}", tjGetErrorStr2(handle.get())));
  }
  Image image = make_image(width, height);
  check_scans(bytes);
  // The accurate transform gives the same bytes on every processor.
  if (tjDecompress2(handle.get(), data, bytes.size(), image.rgb.data(), width, 0, height, TJPF_RGB,
                    TJFLAG_ACCURATEDCT | TJFLAG_STOPONWARNING) != 0) {
    throw Error(fmt::format("is no readable JPEG: {}", tjGetErrorStr2(handle.get())));
  }
  return image;
}

}  // namespace

bool has_image_extension(std::string_view name) {
  std::string lower(name);
  for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return lower.ends_with(".png") || lower.ends_with(".jpg") || lower.ends_with(".jpeg");
}

Image decode_image(std::string_view bytes) {
  if (bytes.starts_with("\x89PNG\r\n\x1a\n")) return decode_png(bytes);
  if (bytes.starts_with("\xff\xd8\xff")) return decode_jpeg(bytes);
  throw Error("is neither a PNG nor a JPEG");
}

}  // namespace weft::scenes
