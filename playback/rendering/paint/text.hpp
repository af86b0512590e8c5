#pragma once

// Tested by tests/playback/rendering/montage_test.cpp.

#include <string_view>

#include <weft/playback/rendering/image.hpp>
#include <weft/playback/rendering/paint/color_map.hpp>

namespace weft::scenes {

/// Draws into finished pictures with the built-in font (Inter; ASCII and the signs of units). Text
/// is UTF-8; characters that the font does not have appear as its empty box.

/// Width of one line [pixel].
[[nodiscard]] float text_width(std::string_view text, float height);

/// Draws one line; x is the left end, y the base line, height the size of the letters' em [pixel].
/// What lies outside of the picture is left out.
void draw_text(Image& image, std::string_view text, float x, float y, float height,
               const Rgb& color);

}  // namespace weft::scenes
