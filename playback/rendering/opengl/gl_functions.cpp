#include <weft/playback/rendering/opengl/gl_functions.hpp>

#include <fmt/format.h>

#include <weft/core/error.hpp>

namespace weft::scenes {
namespace {

GlContext::Function find_or_throw(const GlContext& context, const char* name) {
  const GlContext::Function function = context.find_function(name);
  if (function == nullptr) {
    throw Error(
        fmt::format("OpenGL: function = {}, expected it in {}", name, context.description()));
  }
  return function;
}

}  // namespace

GlFunctions load_gl_functions(const GlContext& context) {
  GlFunctions gl;
#define WEFT_GL_LOAD(type, name) \
  gl.name = reinterpret_cast<type>(find_or_throw(context, "gl" #name));
  WEFT_GL_FUNCTIONS(WEFT_GL_LOAD)
#undef WEFT_GL_LOAD
  return gl;
}

}  // namespace weft::scenes
