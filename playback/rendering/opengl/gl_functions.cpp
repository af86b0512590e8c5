#include <weft/playback/rendering/opengl/gl_functions.hpp>

#include <fmt/format.h>

#include <weft/core/error.hpp>

namespace weft::scenes {
namespace {

OffscreenContext::Function find_or_throw(const OffscreenContext& context, const char* name) {
  const OffscreenContext::Function function = context.find_function(name);
  if (function == nullptr) {
    throw Error(fmt::format("off-screen OpenGL: function = {}, expected it in {}", name,
                            context.description()));
  }
  return function;
}

}  // namespace

GlFunctions load_gl_functions(const OffscreenContext& context) {
  GlFunctions gl;
#define WEFT_GL_LOAD(type, name) \
  gl.name = reinterpret_cast<type>(find_or_throw(context, "gl" #name));
  WEFT_GL_FUNCTIONS(WEFT_GL_LOAD)
#undef WEFT_GL_LOAD
  return gl;
}

}  // namespace weft::scenes
