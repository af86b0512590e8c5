#pragma once

// Tested by tests/playback/rendering/opengl/offscreen_context_test.cpp.

#include <string>

namespace weft::scenes {

/// An OpenGL 3.3 core profile context. Everything that draws is written against this interface, so
/// that a picture in a window and one without a display come from the same code.
class GlContext {
 public:
  using Function = void (*)();

  virtual ~GlContext() = default;

  /// Makes the context the current one of the calling thread. Throws Error if that fails.
  virtual void make_current() = 0;

  /// Address of an OpenGL function, nullptr if there is none.
  [[nodiscard]] virtual Function find_function(const char* name) const = 0;

  /// For messages and logs: which library opened it.
  [[nodiscard]] virtual std::string description() const = 0;
};

}  // namespace weft::scenes
