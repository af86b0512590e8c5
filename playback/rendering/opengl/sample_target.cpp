#include <weft/playback/rendering/opengl/sample_target.hpp>

#include <algorithm>
#include <vector>

#include <weft/core/error.hpp>

namespace weft::scenes {
namespace {

void make_texture(const GlFunctions& gl, GLuint texture, GLint format, GLenum data_format,
                  GLenum type, int width, int height) {
  gl.BindTexture(GL_TEXTURE_2D, texture);
  gl.TexImage2D(GL_TEXTURE_2D, 0, format, width, height, 0, data_format, type, nullptr);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
}

void check_complete(const GlFunctions& gl) {
  if (gl.CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
    throw Error("OpenGL: the framebuffer of a picture is not complete");
  }
}

}  // namespace

SampleTarget::SampleTarget(const GlFunctions& gl)
    : gl_(gl), resolve_(gl, {"screen.vert"}, {"resolve.frag"}) {
  gl.GenVertexArrays(1, &screen_);
  gl.GenFramebuffers(1, &sample_buffer_);
  gl.GenFramebuffers(1, &pixel_buffer_);
  gl.GenTextures(1, &samples_);
  gl.GenTextures(1, &depth_);
  gl.GenTextures(1, &pixels_);
}

SampleTarget::~SampleTarget() {
  for (const GLuint* texture : {&samples_, &depth_, &pixels_}) gl_.DeleteTextures(1, texture);
  for (const GLuint* buffer : {&sample_buffer_, &pixel_buffer_}) gl_.DeleteFramebuffers(1, buffer);
  gl_.DeleteVertexArrays(1, &screen_);
}

void SampleTarget::resize(int width, int height) {
  if (width == width_ && height == height_) return;
  gl_.ActiveTexture(GL_TEXTURE0);
  make_texture(gl_, samples_, GL_RGBA16F, GL_RGBA, GL_FLOAT, width, height);
  make_texture(gl_, depth_, GL_DEPTH_COMPONENT24, GL_DEPTH_COMPONENT, GL_UNSIGNED_INT, width,
               height);
  make_texture(gl_, pixels_, GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE, width, height);
  gl_.BindFramebuffer(GL_FRAMEBUFFER, sample_buffer_);
  gl_.FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, samples_, 0);
  gl_.FramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, depth_, 0);
  check_complete(gl_);
  gl_.BindFramebuffer(GL_FRAMEBUFFER, pixel_buffer_);
  gl_.FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, pixels_, 0);
  check_complete(gl_);
  width_ = width;
  height_ = height;
}

void SampleTarget::begin(const Tile& tile, int samples) {
  resize(tile.width * samples, tile.height * samples);
  gl_.BindFramebuffer(GL_FRAMEBUFFER, sample_buffer_);
  gl_.Viewport(0, 0, width_, height_);
  gl_.DepthMask(GL_TRUE);
  gl_.Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
}

void SampleTarget::resolve(const Tile& tile, int samples) {
  gl_.BindFramebuffer(GL_FRAMEBUFFER, pixel_buffer_);
  gl_.Viewport(0, 0, tile.width, tile.height);
  gl_.Disable(GL_DEPTH_TEST);
  gl_.ActiveTexture(GL_TEXTURE0);
  gl_.BindTexture(GL_TEXTURE_2D, samples_);
  resolve_.use();
  resolve_.set("u_samples", 0);
  resolve_.set("u_num_samples", samples);
  gl_.BindVertexArray(screen_);
  gl_.DrawArrays(GL_TRIANGLES, 0, 3);
}

void SampleTarget::finish(const Tile& tile, int samples, GLuint framebuffer) {
  resolve(tile, samples);
  gl_.BindFramebuffer(GL_READ_FRAMEBUFFER, pixel_buffer_);
  gl_.BindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer);
  gl_.BlitFramebuffer(0, 0, tile.width, tile.height, tile.x, tile.y, tile.x + tile.width,
                      tile.y + tile.height, GL_COLOR_BUFFER_BIT, GL_NEAREST);
}

void SampleTarget::finish(const Tile& tile, int samples, Image& image) {
  resolve(tile, samples);
  const std::size_t row_size = std::size_t{3} * static_cast<std::size_t>(tile.width);
  std::vector<std::uint8_t> bytes(row_size * static_cast<std::size_t>(tile.height));
  gl_.PixelStorei(GL_PACK_ALIGNMENT, 1);
  gl_.ReadPixels(0, 0, tile.width, tile.height, GL_RGB, GL_UNSIGNED_BYTE, bytes.data());
  for (int j = 0; j < tile.height; ++j) {
    // OpenGL counts rows from below, pictures from above.
    const auto row = static_cast<std::size_t>(image.height - 1 - (tile.y + j));
    const std::size_t to = std::size_t{3} * (row * static_cast<std::size_t>(image.width) +
                                             static_cast<std::size_t>(tile.x));
    const auto from = bytes.begin() + static_cast<std::ptrdiff_t>(row_size) * j;
    std::copy(from, from + static_cast<std::ptrdiff_t>(row_size),
              image.rgb.begin() + static_cast<std::ptrdiff_t>(to));
  }
}

}  // namespace weft::scenes
