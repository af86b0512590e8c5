// Tested by tests/playback/rendering/renderer_test.cpp.

#include <weft/playback/rendering/opengl/offscreen_context.hpp>
#include <weft/playback/rendering/renderer.hpp>

namespace weft::scenes {

// A file of its own, so that a program that draws in its own context does not need OSMesa.
Renderer::Renderer(const Scene& scene) : Renderer(scene, open_offscreen_context()) {}

}  // namespace weft::scenes
