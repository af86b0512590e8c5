#include <weft/playback/rendering/paint/text.hpp>

#include <cmath>
#include <vector>

#include <weft/core/error.hpp>
#include <weft/playback/rendering/assets.hpp>

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#define STBTT_STATIC
#define STB_TRUETYPE_IMPLEMENTATION
#include <stb_truetype.h>
#pragma GCC diagnostic pop

namespace weft::scenes {
namespace {

const stbtt_fontinfo& font() {
  static const stbtt_fontinfo info = [] {
    stbtt_fontinfo result{};
    const Asset& asset = find_asset("font/inter-medium-ascii.otf");
    if (stbtt_InitFont(&result, asset.bytes, 0) == 0) {
      throw Error("playback: the built-in font cannot be read");
    }
    return result;
  }();
  return info;
}

/// Next code point of a UTF-8 text; a broken sequence gives its bytes one by one.
int next_code_point(std::string_view text, std::size_t& at) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char lead = byte(at);
  const std::size_t size = lead < 0x80 ? 1 : lead < 0xE0 ? 2 : lead < 0xF0 ? 3 : 4;
  if (size == 1 || at + size > text.size()) return byte(at++);
  int point = lead & (0xFF >> (size + 1));
  for (std::size_t i = 1; i < size; ++i) point = (point << 6) | (byte(at + i) & 0x3F);
  at += size;
  return point;
}

/// Visits the glyphs of a line with their places; returns the width.
template <class Visit>
float walk(std::string_view text, float scale, Visit visit) {
  float x = 0.0f;
  for (std::size_t at = 0; at < text.size();) {
    const int glyph = stbtt_FindGlyphIndex(&font(), next_code_point(text, at));
    visit(glyph, x);
    int advance = 0;
    int bearing = 0;
    stbtt_GetGlyphHMetrics(&font(), glyph, &advance, &bearing);
    x += scale * static_cast<float>(advance);
  }
  return x;
}

/// Mixes in linear light, so that thin strokes keep their weight on any background.
void blend(Image& image, int column, int row, const Eigen::Vector3f& light, float coverage) {
  if (column < 0 || row < 0 || column >= image.width || row >= image.height) return;
  std::uint8_t* pixel =
      image.rgb.data() +
      std::size_t{3} * (static_cast<std::size_t>(row) * static_cast<std::size_t>(image.width) +
                        static_cast<std::size_t>(column));
  const Eigen::Vector3f under = linear_light({pixel[0], pixel[1], pixel[2]});
  const Rgb mixed = encode_srgb((1.0f - coverage) * under + coverage * light);
  std::copy(mixed.begin(), mixed.end(), pixel);
}

}  // namespace

float text_width(std::string_view text, float height) {
  return walk(text, stbtt_ScaleForMappingEmToPixels(&font(), height), [](int, float) {});
}

void draw_text(Image& image, std::string_view text, float x, float y, float height,
               const Rgb& color) {
  const float scale = stbtt_ScaleForMappingEmToPixels(&font(), height);
  const Eigen::Vector3f light = linear_light(color);
  std::vector<unsigned char> coverage;
  walk(text, scale, [&](int glyph, float offset) {
    const float shift = x + offset - std::floor(x + offset);
    int x0 = 0;
    int y0 = 0;
    int x1 = 0;
    int y1 = 0;
    stbtt_GetGlyphBitmapBoxSubpixel(&font(), glyph, scale, scale, shift, 0.0f, &x0, &y0, &x1, &y1);
    const int width = x1 - x0;
    const int rows = y1 - y0;
    if (width <= 0 || rows <= 0) return;
    coverage.assign(static_cast<std::size_t>(width) * static_cast<std::size_t>(rows), 0);
    stbtt_MakeGlyphBitmapSubpixel(&font(), coverage.data(), width, rows, width, scale, scale, shift,
                                  0.0f, glyph);
    const int left = static_cast<int>(std::floor(x + offset)) + x0;
    const int top = static_cast<int>(std::lround(y)) + y0;
    for (int j = 0; j < rows; ++j) {
      for (int i = 0; i < width; ++i) {
        const unsigned char value = coverage[static_cast<std::size_t>(j * width + i)];
        if (value > 0) blend(image, left + i, top + j, light, static_cast<float>(value) / 255.0f);
      }
    }
  });
}

}  // namespace weft::scenes
