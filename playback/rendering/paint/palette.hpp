#pragma once

// Tested by tests/playback/rendering/renderer_test.cpp.

#include <array>

#include <weft/playback/rendering/paint/color_map.hpp>

namespace weft::scenes {

struct ClothColors {
  Rgb front;
  Rgb back;
};

/// One pair per cloth, then from the start again: a strong front and a light back of the opposite
/// temperature, so that sides are told apart by hue and by lightness.
inline constexpr std::array<ClothColors, 4> kClothPalette = {{{{58, 116, 186}, {244, 186, 124}},
                                                              {{190, 78, 58}, {236, 216, 170}},
                                                              {{52, 138, 112}, {238, 206, 150}},
                                                              {{116, 88, 160}, {232, 200, 214}}}};

inline constexpr Rgb kFixedBodyColor = {222, 220, 216};
inline constexpr ClothColors kMovingBodyColors = {{214, 120, 84}, {244, 232, 214}};

}  // namespace weft::scenes
