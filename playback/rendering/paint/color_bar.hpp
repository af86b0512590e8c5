#pragma once

// Tested by tests/playback/rendering/renderer_test.cpp.

#include <string>

#include <weft/playback/rendering/image.hpp>
#include <weft/playback/rendering/paint/color_map.hpp>

namespace weft::scenes {

/// Where the colours of the bar are: rows from top (maximum) to bottom (minimum) [pixel].
struct ColorBarPlace {
  int left = 0;
  int top = 0;
  int width = 0;
  int height = 0;
};

/// The place in a picture; width = 0 where a picture is too small for a bar.
[[nodiscard]] ColorBarPlace color_bar_place(int image_width, int image_height);

/// Draws the bar with its label above and numbers at its ends (and at zero, if it is inside).
void draw_color_bar(Image& image, const ColorMap& map, const std::string& label);

}  // namespace weft::scenes
