#pragma once

// Tested by tests/playback/rendering/appearance_render_test.cpp.

#include <weft/playback/rendering/image.hpp>
#include <weft/scenes/appearance/appearance.hpp>

namespace weft::scenes {

/// Colours of a pattern.
struct PatternColors {
  Rgb ground;
  Rgb figure;
};

/// Colours that fit a pattern, where a scene gives none.
[[nodiscard]] PatternColors default_colors(Pattern pattern, const Rgb& body_color);

/// One repetition of a pattern, size x size pixels, u to the right and v upwards. All but kEyeball
/// continue across their borders. kEyeball is seen from the front of a ball: the distance from the
/// middle is the angle from its axis, the border is the point on the far side.
[[nodiscard]] Image pattern_image(Pattern pattern, const PatternColors& colors, int size);

}  // namespace weft::scenes
