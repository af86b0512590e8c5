#pragma once

// Tested by tests/playback/rendering/renderer_test.cpp.

#include <weft/playback/rendering/image.hpp>
#include <weft/playback/rendering/opengl/shader_program.hpp>

namespace weft::scenes {

/// A part of a picture that is drawn at once; large pictures are put together from tiles. [pixel],
/// y from below.
struct Tile {
  int x = 0;
  int y = 0;
  int width = 0;
  int height = 0;
};

/// Where samples are drawn, in linear light, and the pass that averages them into pixels.
class SampleTarget {
 public:
  /// Largest tile, per axis. [sample]
  static constexpr int kMaxSamples = 2048;

  explicit SampleTarget(const GlFunctions& gl);
  ~SampleTarget();
  SampleTarget(const SampleTarget&) = delete;
  SampleTarget& operator=(const SampleTarget&) = delete;

  /// Makes the target the current one, empty, with the size of the tile.
  void begin(const Tile& tile, int samples);
  /// Averages the samples of the tile and stores them in the picture.
  void finish(const Tile& tile, int samples, Image& image);
  /// The same into a framebuffer of the context, whose lower left corner is that of the picture.
  void finish(const Tile& tile, int samples, GLuint framebuffer);

 private:
  void resize(int width, int height);
  void resolve(const Tile& tile, int samples);

  const GlFunctions& gl_;
  ShaderProgram resolve_;
  GLuint screen_ = 0;
  GLuint sample_buffer_ = 0;
  GLuint samples_ = 0;
  GLuint depth_ = 0;
  GLuint pixel_buffer_ = 0;
  GLuint pixels_ = 0;
  int width_ = 0;
  int height_ = 0;
};

}  // namespace weft::scenes
