#include <weft/playback/rendering/opengl/shader_program.hpp>

#include <array>

#include <fmt/format.h>

#include <weft/core/error.hpp>
#include <weft/playback/rendering/assets.hpp>

namespace weft::scenes {
namespace {

constexpr GLsizei kLogSize = 1024;

GLuint compile(const GlFunctions& gl, GLenum kind, const ShaderProgram::Files& files) {
  std::string source = asset_text("shaders/prelude.glsl");
  for (const std::string& file : files) source += asset_text("shaders/" + file);
  const GLchar* text = source.c_str();
  const GLuint shader = gl.CreateShader(kind);
  gl.ShaderSource(shader, 1, &text, nullptr);
  gl.CompileShader(shader);
  GLint status = 0;
  gl.GetShaderiv(shader, GL_COMPILE_STATUS, &status);
  if (status != GL_TRUE) {
    std::array<GLchar, kLogSize> log{};
    gl.GetShaderInfoLog(shader, kLogSize, nullptr, log.data());
    const std::string text(log.data());
    throw Error(fmt::format("OpenGL: shader '{}' does not compile: {}", files.back(),
                            text.substr(0, text.find('\n'))));
  }
  return shader;
}

}  // namespace

ShaderProgram::ShaderProgram(const GlFunctions& gl, const Files& vertex_files,
                             const Files& fragment_files)
    : gl_(gl), program_(gl.CreateProgram()) {
  const GLuint vertex = compile(gl, GL_VERTEX_SHADER, vertex_files);
  const GLuint fragment = compile(gl, GL_FRAGMENT_SHADER, fragment_files);
  gl.AttachShader(program_, vertex);
  gl.AttachShader(program_, fragment);
  gl.LinkProgram(program_);
  gl.DeleteShader(vertex);
  gl.DeleteShader(fragment);
  GLint status = 0;
  gl.GetProgramiv(program_, GL_LINK_STATUS, &status);
  if (status != GL_TRUE) {
    std::array<GLchar, kLogSize> log{};
    gl.GetProgramInfoLog(program_, kLogSize, nullptr, log.data());
    const std::string text(log.data());
    throw Error(fmt::format("OpenGL: shaders '{}' and '{}' do not link: {}", vertex_files.back(),
                            fragment_files.back(), text.substr(0, text.find('\n'))));
  }
}

ShaderProgram::~ShaderProgram() {
  gl_.DeleteProgram(program_);
}

void ShaderProgram::use() const {
  gl_.UseProgram(program_);
}

GLint ShaderProgram::location(const char* name) const {
  return gl_.GetUniformLocation(program_, name);
}

void ShaderProgram::set(const char* name, int value) const {
  gl_.Uniform1i(location(name), value);
}

void ShaderProgram::set(const char* name, float value) const {
  gl_.Uniform1f(location(name), value);
}

void ShaderProgram::set(const char* name, const Eigen::Vector2f& value) const {
  gl_.Uniform2f(location(name), value.x(), value.y());
}

void ShaderProgram::set(const char* name, const Eigen::Vector3f& value) const {
  gl_.Uniform3fv(location(name), 1, value.data());
}

void ShaderProgram::set(const char* name, const Eigen::Matrix4f& value) const {
  gl_.UniformMatrix4fv(location(name), 1, GL_FALSE, value.data());
}

void ShaderProgram::set(const char* name, const std::vector<Eigen::Vector3f>& values) const {
  if (values.empty()) return;
  gl_.Uniform3fv(location(name), static_cast<GLsizei>(values.size()), values.front().data());
}

void ShaderProgram::set(const char* name, const std::vector<Eigen::Matrix4f>& values) const {
  if (values.empty()) return;
  gl_.UniformMatrix4fv(location(name), static_cast<GLsizei>(values.size()), GL_FALSE,
                       values.front().data());
}

}  // namespace weft::scenes
