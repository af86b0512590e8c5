#pragma once

// Tested by tests/playback/rendering/renderer_test.cpp.

#include <string>
#include <vector>

#include <Eigen/Core>

#include <weft/playback/rendering/opengl/gl_functions.hpp>

namespace weft::scenes {

/// A linked pair of shaders from playback/rendering/shaders. Its context must be the current one when it is deleted.
class ShaderProgram {
 public:
  using Files = std::vector<std::string>;

  /// A shader is "prelude.glsl" and then the given files, one after the other.
  /// Throws Error with the compiler's first line.
  ShaderProgram(const GlFunctions& gl, const Files& vertex_files, const Files& fragment_files);

  ~ShaderProgram();
  ShaderProgram(const ShaderProgram&) = delete;
  ShaderProgram& operator=(const ShaderProgram&) = delete;

  void use() const;

  /// Sets a uniform of the program, which must be in use. A name that the compiler optimised away
  /// is ignored.
  void set(const char* name, int value) const;
  void set(const char* name, float value) const;
  void set(const char* name, const Eigen::Vector2f& value) const;
  void set(const char* name, const Eigen::Vector3f& value) const;
  void set(const char* name, const Eigen::Matrix4f& value) const;
  void set(const char* name, const std::vector<Eigen::Vector3f>& values) const;
  void set(const char* name, const std::vector<Eigen::Matrix4f>& values) const;

 private:
  [[nodiscard]] GLint location(const char* name) const;

  const GlFunctions& gl_;
  GLuint program_ = 0;
};

}  // namespace weft::scenes
