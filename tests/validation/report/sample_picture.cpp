#include "tests/validation/report/sample_picture.hpp"

#include <png.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <vector>

namespace weft::tests {
namespace {

constexpr int kWidth = 320;
constexpr int kHeight = 240;

struct Color {
  double r, g, b;
};

// x and y run from -1 to 1 over the picture.
Color pixel(double x, double y, double sag) {
  const double fold = 0.06 * std::sin(14.0 * x) * (0.3 + sag);
  const double edge = 0.35 + 0.5 * sag * (1.0 - x * x) + fold;
  const bool cloth = std::abs(x) < 0.85 && y > -0.45 && y < edge;
  if (!cloth) {
    const double shade = 0.93 - 0.08 * (y + 1.0);
    return {shade, shade, shade + 0.02};
  }
  const double light = 0.62 + 0.25 * std::cos(14.0 * x) * (0.3 + 0.5 * sag) - 0.18 * y;
  const bool check =
      (static_cast<int>(std::floor(10 * x)) + static_cast<int>(std::floor(10 * y))) % 2;
  return check ? Color{0.85 * light, 0.35 * light, 0.25 * light}
               : Color{light, 0.9 * light, 0.8 * light};
}

std::uint8_t to_byte(double value) {
  return static_cast<std::uint8_t>(std::lround(255.0 * std::clamp(value, 0.0, 1.0)));
}

}  // namespace

std::string sample_png(double sag) {
  std::vector<std::uint8_t> rgb;
  for (int row = 0; row < kHeight; ++row) {
    for (int column = 0; column < kWidth; ++column) {
      const Color c = pixel(2.0 * column / kWidth - 1.0, 2.0 * row / kHeight - 1.0, sag);
      rgb.insert(rgb.end(), {to_byte(c.r), to_byte(c.g), to_byte(c.b)});
    }
  }
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = kWidth;
  image.height = kHeight;
  image.format = PNG_FORMAT_RGB;
  png_alloc_size_t size = 0;
  if (!png_image_write_to_memory(&image, nullptr, &size, 0, rgb.data(), 0, nullptr)) {
    throw std::runtime_error("sample_png: libpng cannot size the picture");
  }
  std::string bytes(size, '\0');
  if (!png_image_write_to_memory(&image, bytes.data(), &size, 0, rgb.data(), 0, nullptr)) {
    throw std::runtime_error("sample_png: libpng cannot write the picture");
  }
  bytes.resize(size);
  return bytes;
}

}  // namespace weft::tests
