// A picture, PNG or JPEG.
#include <weft/core/error.hpp>
#include <weft/scenes/appearance/image_file.hpp>
#include "fuzz/fuzz_target.hpp"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace weft;
  try {
    const scenes::Image image = scenes::decode_image(fuzz::text_of(data, size));
    const auto num_pixels =
        static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
    fuzz::require(num_pixels > 0 && image.rgb.size() == 3 * num_pixels,
                  "a picture has three bytes for each pixel");
  } catch (const Error& error) {
    fuzz::require_clear(error.what());
  }
  return 0;
}
