#include <turbojpeg.h>

#include <memory>
#include <string>

#include <fmt/format.h>

#include <weft/core/error.hpp>
#include <weft/playback/rendering/image.hpp>

namespace weft::scenes {

std::string encode_jpeg(const Image& image, int quality) {
  const std::size_t expected = std::size_t{3} * static_cast<std::size_t>(image.width) *
                               static_cast<std::size_t>(image.height);
  if (image.width < 1 || image.height < 1 || image.rgb.size() != expected || quality < 1 ||
      quality > 100) {
    throw InvalidArgument(fmt::format(
        "encode_jpeg: image = {} x {} pixels with {} bytes, quality = {}, expected width, "
        "height >= 1, {} bytes and a quality of 1 to 100",
        image.width, image.height, image.rgb.size(), quality, expected));
  }
  struct Destroy {
    void operator()(void* handle) const { tjDestroy(handle); }
  };
  struct Free {
    void operator()(unsigned char* bytes) const { tjFree(bytes); }
  };
  const std::unique_ptr<void, Destroy> handle(tjInitCompress());
  if (!handle) throw Error("encode_jpeg: out of memory");
  unsigned char* made = nullptr;
  unsigned long size = 0;
  // Full colour resolution keeps thin coloured lines sharp; the accurate transform gives the same bytes on every
  // processor.
  const int result = tjCompress2(handle.get(), image.rgb.data(), image.width, 0, image.height,
                                 TJPF_RGB, &made, &size, TJSAMP_444, quality, TJFLAG_ACCURATEDCT);
  const std::unique_ptr<unsigned char, Free> owned(made);
  if (result != 0) throw Error(fmt::format("encode_jpeg: {}", tjGetErrorStr2(handle.get())));
  return {reinterpret_cast<const char*>(made), size};
}

}  // namespace weft::scenes
