#pragma once

// Tested by tests/playback/rendering/appearance_render_test.cpp.

#include <vector>

#include <weft/playback/rendering/opengl/shader_program.hpp>
#include <weft/playback/rendering/paint/body_look.hpp>
#include <weft/scenes/scene.hpp>

namespace weft::scenes {

/// How a body is painted. It lives as long as its context.
struct BodyPaint {
  using Mapping = TextureMapping;

  Eigen::Vector3f front{1, 1, 1};  ///< linear light
  Eigen::Vector3f back{1, 1, 1};   ///< linear light
  Mapping mapping = Mapping::kNoTexture;
  GLuint texture = 0;
  Eigen::Vector2f repeat{1, 1};
  bool texture_on_back = false;
  bool is_flat = false;
  bool is_visible = true;
  bool is_two_tone = false;  ///< octants in both colours, which show how a plain ball turns

  void set(const GlFunctions& gl, const ShaderProgram& program, GLint texture_unit) const;
};

/// index chooses from the palette; has_coordinates: whether the mesh has texture coordinates.
[[nodiscard]] BodyPaint cloth_paint(const GlFunctions& gl, const Scene& scene, std::size_t index,
                                    bool has_coordinates);
[[nodiscard]] BodyPaint collider_paint(const GlFunctions& gl, const Scene& scene,
                                       const Collider& collider);

}  // namespace weft::scenes
