#pragma once

#include <memory>

#include <weft/playback/rendering/opengl/gl_context.hpp>

namespace weft::scenes {

struct GlVersion {
  int major = 3;
  int minor = 3;
};

/// Opens a context on OSMesa: a software renderer, no display and no graphics card needed.
/// Throws Error if the version is not available.
[[nodiscard]] std::unique_ptr<GlContext> open_offscreen_context(GlVersion version = {});

}  // namespace weft::scenes
