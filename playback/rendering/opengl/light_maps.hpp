#pragma once

// Tested by tests/playback/rendering/renderer_test.cpp.

#include <functional>
#include <vector>

#include <weft/playback/rendering/opengl/shader_program.hpp>
#include <weft/playback/rendering/opengl/shadow_bounds.hpp>

namespace weft::scenes {

/// Depth maps seen from the lights: a fine one for the key light, a stack of coarse ones for the
/// sky.
class LightMaps {
 public:
  explicit LightMaps(const GlFunctions& gl);
  ~LightMaps();
  LightMaps(const LightMaps&) = delete;
  LightMaps& operator=(const LightMaps&) = delete;

  /// Draws the maps again for casters within the radius [m] around the centre. draw_casters gets
  /// the program of the depth pass to set "u_world_from_body" of each body.
  void update(const Eigen::Vector3f& key_direction, const Eigen::Vector3f& center, double radius,
              const std::function<void(const ShaderProgram&)>& draw_casters);

  enum class Receiver { kGround, kBody };
  /// Binds the maps and sets everything that scene.vert and key_light.glsl read, except
  /// u_show_shadow.
  void bind(const ShaderProgram& program, Receiver receiver) const;

 private:
  const GlFunctions& gl_;
  ShaderProgram depth_program_;
  ShadowBounds key_bounds_;
  GLuint framebuffer_ = 0;
  GLuint key_map_ = 0;
  GLuint sky_maps_ = 0;
  double radius_ = 1.0;
  Eigen::Vector3f key_direction_{0, 1, 0};
  Eigen::Matrix4f key_matrix_;
  std::vector<Eigen::Vector3f> sky_directions_;
  std::vector<Eigen::Matrix4f> sky_matrices_;
  std::vector<Eigen::Vector3f> sky_taps_;
};

}  // namespace weft::scenes
