#include <weft/playback/rendering/opengl/shadow_bounds.hpp>

#include <weft/core/error.hpp>

namespace weft::scenes {
namespace {

constexpr GLint kMapUnit = 0;

}  // namespace

ShadowBounds::ShadowBounds(const GlFunctions& gl, int size)
    : gl_(gl), program_(gl, {"screen.vert"}, {"shadow_bounds.frag"}), size_(size / kBlock) {
  gl.GenVertexArrays(1, &screen_);
  gl.GenFramebuffers(1, &framebuffer_);
  for (GLuint* texture : {&blocks_, &dilated_}) {
    gl.GenTextures(1, texture);
    gl.BindTexture(GL_TEXTURE_2D, *texture);
    gl.TexImage2D(GL_TEXTURE_2D, 0, GL_RG32F, size_, size_, 0, GL_RG, GL_FLOAT, nullptr);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  }
}

ShadowBounds::~ShadowBounds() {
  for (const GLuint* texture : {&blocks_, &dilated_}) gl_.DeleteTextures(1, texture);
  gl_.DeleteFramebuffers(1, &framebuffer_);
  gl_.DeleteVertexArrays(1, &screen_);
}

void ShadowBounds::update(GLuint depth_map) {
  gl_.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  gl_.Viewport(0, 0, size_, size_);
  gl_.Disable(GL_DEPTH_TEST);
  gl_.ActiveTexture(GL_TEXTURE0 + kMapUnit);
  gl_.BindTexture(GL_TEXTURE_2D, depth_map);
  gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_MODE, GL_NONE);
  program_.use();
  program_.set("u_map", kMapUnit);
  reduce(depth_map, blocks_, kBlock, 0, true);
  gl_.BindTexture(GL_TEXTURE_2D, depth_map);
  gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
  reduce(blocks_, dilated_, 1, 1, false);
}

void ShadowBounds::reduce(GLuint from, GLuint to, int stride, int margin, bool is_depth) {
  gl_.FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, to, 0);
  if (gl_.CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
    throw Error("OpenGL: the framebuffer of the shadow's bounds is not complete");
  }
  gl_.BindTexture(GL_TEXTURE_2D, from);
  program_.set("u_stride", stride);
  program_.set("u_margin", margin);
  program_.set("u_is_depth", is_depth ? 1 : 0);
  gl_.BindVertexArray(screen_);
  gl_.DrawArrays(GL_TRIANGLES, 0, 3);
}

}  // namespace weft::scenes
