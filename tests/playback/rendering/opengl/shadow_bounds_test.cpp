#include <weft/playback/rendering/opengl/shadow_bounds.hpp>

#include <algorithm>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <weft/playback/rendering/opengl/offscreen_context.hpp>

namespace weft::scenes {
namespace {

constexpr int kMapSize = 64;  // [texel]
constexpr int kBlocks = kMapSize / ShadowBounds::kBlock;

GLuint depth_map(const GlFunctions& gl, const std::vector<float>& depths) {
  GLuint map = 0;
  gl.GenTextures(1, &map);
  gl.BindTexture(GL_TEXTURE_2D, map);
  gl.TexImage2D(GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT32F, kMapSize, kMapSize, 0, GL_DEPTH_COMPONENT,
                GL_FLOAT, depths.data());
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
  return map;
}

TEST(ShadowBoundsTest, AreTheExtremesOfABlockAndItsNeighbors) {
  const auto context = open_offscreen_context();
  context->make_current();
  const GlFunctions gl = load_gl_functions(*context);
  std::mt19937 random(7);
  std::vector<float> depths(kMapSize * kMapSize);
  for (float& depth : depths) depth = 0.1f + 0.8f * static_cast<float>(random() % 1000) / 1000.0f;
  const GLuint map = depth_map(gl, depths);
  ShadowBounds bounds(gl, kMapSize);
  bounds.update(map);

  GLuint framebuffer = 0;
  gl.GenFramebuffers(1, &framebuffer);
  gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  gl.FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, bounds.texture(), 0);
  std::vector<float> found(2 * kBlocks * kBlocks);
  gl.ReadPixels(0, 0, kBlocks, kBlocks, GL_RG, GL_FLOAT, found.data());
  for (int row = 0; row < kBlocks; ++row) {
    for (int column = 0; column < kBlocks; ++column) {
      float low = 1.0f;
      float high = 0.0f;
      for (int y = 0; y < kMapSize; ++y) {
        for (int x = 0; x < kMapSize; ++x) {
          const bool is_near = std::abs(y / ShadowBounds::kBlock - row) <= 1 &&
                               std::abs(x / ShadowBounds::kBlock - column) <= 1;
          if (!is_near) continue;
          const float depth = depths[static_cast<std::size_t>(kMapSize * y + x)];
          low = std::min(low, depth);
          high = std::max(high, depth);
        }
      }
      const auto at = static_cast<std::size_t>(2 * (kBlocks * row + column));
      EXPECT_EQ(found[at], low) << row << ' ' << column;
      EXPECT_EQ(found[at + 1], high) << row << ' ' << column;
    }
  }
  gl.DeleteFramebuffers(1, &framebuffer);
  gl.DeleteTextures(1, &map);
}

}  // namespace
}  // namespace weft::scenes
