#pragma once

// Tested by tests/playback/rendering/golden_test.cpp.

#include <memory>

#include <weft/playback/rendering/opengl/offscreen_context.hpp>

namespace weft::scenes {

/// Opens a context on EGL without a surface, which needs no display either: on a graphics card where Mesa finds one, else on
/// its software renderer. Throws Error if there is no such EGL, or the version is not available.
[[nodiscard]] std::unique_ptr<GlContext> open_egl_context(GlVersion version = {});

}  // namespace weft::scenes
