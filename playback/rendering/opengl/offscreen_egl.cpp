// Tested by tests/playback/rendering/golden_test.cpp.

#include <weft/playback/rendering/opengl/egl_context.hpp>

namespace weft::scenes {

// In the place of OSMesa's, in a build with WEFT_OFFSCREEN=EGL.
std::unique_ptr<GlContext> open_offscreen_context(GlVersion version) {
  return open_egl_context(version);
}

}  // namespace weft::scenes
