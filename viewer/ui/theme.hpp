#pragma once

// Tested by tests/viewer/window_test.py.

#include <imgui.h>

namespace weft::viewer {

/// What is drawn over the picture itself, which may have any color.
inline constexpr ImU32 kInk = IM_COL32(20, 22, 26, 255);
inline constexpr ImU32 kPaper = IM_COL32(255, 255, 255, 215);

/// Font, colors and sizes of the panels at a scale [-]; may be called again for another one.
void apply_theme(double scale);

}  // namespace weft::viewer
