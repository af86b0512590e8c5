#pragma once

// Tested by tests/playback/rendering/opengl/shadow_bounds_test.cpp.

#include <weft/playback/rendering/opengl/shader_program.hpp>

namespace weft::scenes {

/// Smallest and largest depth of a depth map around each block of its texels. Most places are lit or dark as a whole: there
/// these two numbers are the answer of a filter, whatever it looks like, and it need not be evaluated.
class ShadowBounds {
 public:
  /// A block has so many texels along each side, and a map a multiple of it. A filter may look as far, less one texel.
  static constexpr int kBlock = 16;

  /// size: of the map [texel].
  ShadowBounds(const GlFunctions& gl, int size);
  ~ShadowBounds();
  ShadowBounds(const ShadowBounds&) = delete;
  ShadowBounds& operator=(const ShadowBounds&) = delete;

  /// depth_map: a two-dimensional depth texture, whose comparison is off during the call.
  void update(GLuint depth_map);
  /// Red is the smallest depth, green the largest: a texel for each block.
  [[nodiscard]] GLuint texture() const { return dilated_; }

 private:
  void reduce(GLuint from, GLuint to, int stride, int margin, bool is_depth);

  const GlFunctions& gl_;
  ShaderProgram program_;
  int size_;  ///< [block]
  GLuint screen_ = 0;
  GLuint framebuffer_ = 0;
  GLuint blocks_ = 0;
  GLuint dilated_ = 0;
};

}  // namespace weft::scenes
