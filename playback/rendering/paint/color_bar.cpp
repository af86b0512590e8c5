#include <weft/playback/rendering/paint/color_bar.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <weft/playback/rendering/paint/text.hpp>

namespace weft::scenes {
namespace {

constexpr Rgb kInk = {52, 60, 70};
/// Height of the capitals as a part of the em, Inter's own number.
constexpr float kCapitalRatio = 0.73f;

float text_height(int image_height) {
  return std::max(11.0f, static_cast<float>(image_height) / 36.0f);
}

void set_pixel(Image& image, int column, int row, const Rgb& color) {
  const std::size_t at =
      std::size_t{3} * (static_cast<std::size_t>(row) * static_cast<std::size_t>(image.width) +
                        static_cast<std::size_t>(column));
  std::copy(color.begin(), color.end(), image.rgb.begin() + static_cast<std::ptrdiff_t>(at));
}

/// At most three digits and a real minus sign.
std::string number(double value) {
  std::string text = fmt::format("{:.3g}", value);
  if (text.front() == '-') text.replace(0, 1, "\u2212");
  return text;
}

}  // namespace

ColorBarPlace color_bar_place(int image_width, int image_height) {
  ColorBarPlace place;
  constexpr int kSmallest = 160;  // below this the numbers would cover the picture
  if (image_width < kSmallest || image_height < kSmallest) return place;
  const int text = static_cast<int>(std::lround(text_height(image_height)));
  place.width = std::max(10, image_height / 40);
  place.height = image_height * 2 / 5;
  place.left = image_width - place.width - 5 * text;
  place.top = (image_height - place.height) / 2;
  return place;
}

void draw_color_bar(Image& image, const ColorMap& map, const std::string& label) {
  const ColorBarPlace place = color_bar_place(image.width, image.height);
  if (place.width == 0) return;
  const double span = map.maximum() - map.minimum();
  for (int row = 0; row < place.height; ++row) {
    const double part = static_cast<double>(row) / (place.height - 1);
    const Rgb color = map.color(map.maximum() - part * span);
    for (int column = 0; column < place.width; ++column) {
      set_pixel(image, place.left + column, place.top + row, color);
    }
  }
  const float height = text_height(image.height);
  const auto write_number = [&](double value, double part) {
    const float y =
        static_cast<float>(place.top + part * (place.height - 1)) + 0.5f * kCapitalRatio * height;
    draw_text(image, number(value), static_cast<float>(place.left + place.width) + 0.5f * height, y,
              height, kInk);
  };
  write_number(map.maximum(), 0.0);
  if (span > 0.0) {
    write_number(map.minimum(), 1.0);
    const double zero = map.maximum() / span;
    const double clear = 1.5 * height / place.height;
    if (zero > clear && zero < 1.0 - clear) write_number(0.0, zero);
  }
  const float margin = 0.75f * height;
  const float width = text_width(label, height);
  const float x = std::max(margin, std::min(static_cast<float>(place.left),
                                            static_cast<float>(image.width) - margin - width));
  draw_text(image, label, x, static_cast<float>(place.top) - 1.1f * height, height, kInk);
}

}  // namespace weft::scenes
