#include <weft/playback/rendering/paint/body_paint.hpp>

#include <cstddef>
#include <cstdint>

#include <weft/playback/rendering/paint/color_map.hpp>

namespace weft::scenes {
namespace {

// From EXT_texture_filter_anisotropic; core OpenGL only since 4.6. Without it a picture that is seen
// at a glancing angle is blurred.
constexpr GLenum kMaxAnisotropy = 0x84FE;

GLuint upload(const GlFunctions& gl, const Image& image) {
  // OpenGL's first row is the lowest.
  const std::size_t stride = std::size_t{3} * static_cast<std::size_t>(image.width);
  std::vector<std::uint8_t> rows;
  rows.reserve(image.rgb.size());
  for (int row = image.height - 1; row >= 0; --row) {
    const auto begin = image.rgb.begin() + static_cast<std::ptrdiff_t>(stride) * row;
    rows.insert(rows.end(), begin, begin + static_cast<std::ptrdiff_t>(stride));
  }
  GLuint texture = 0;
  gl.GenTextures(1, &texture);
  gl.ActiveTexture(GL_TEXTURE0);
  gl.BindTexture(GL_TEXTURE_2D, texture);
  gl.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
  gl.TexImage2D(GL_TEXTURE_2D, 0, GL_SRGB8, image.width, image.height, 0, GL_RGB, GL_UNSIGNED_BYTE,
                rows.data());
  gl.GenerateMipmap(GL_TEXTURE_2D);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_REPEAT);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_REPEAT);
  gl.TexParameterf(GL_TEXTURE_2D, kMaxAnisotropy, 8.0f);
  (void)gl.GetError();  // of the line above, where the extension is missing
  return texture;
}

BodyPaint paint_of(const GlFunctions& gl, const BodyLook& look, const Appearance& appearance) {
  BodyPaint paint;
  paint.front = linear_light(look.front);
  paint.back = look.back;
  paint.mapping = look.mapping;
  if (look.picture) paint.texture = upload(gl, *look.picture);
  paint.repeat = {static_cast<float>(appearance.texture_repeat[0]),
                  static_cast<float>(appearance.texture_repeat[1])};
  paint.texture_on_back = look.texture_on_back;
  paint.is_flat = !appearance.smooth;
  paint.is_visible = appearance.visible;
  paint.is_two_tone = look.is_two_tone;
  return paint;
}

}  // namespace

void BodyPaint::set(const GlFunctions& gl, const ShaderProgram& program, GLint texture_unit) const {
  program.set("u_front_color", front);
  program.set("u_back_color", back);
  program.set("u_mapping", static_cast<int>(mapping));
  program.set("u_repeat", repeat);
  program.set("u_texture_on_back", texture_on_back ? 1 : 0);
  program.set("u_is_flat", is_flat ? 1 : 0);
  program.set("u_texture", texture_unit);
  gl.ActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(texture_unit));
  gl.BindTexture(GL_TEXTURE_2D, texture);
}

BodyPaint cloth_paint(const GlFunctions& gl, const Scene& scene, std::size_t index,
                      bool has_coordinates) {
  return paint_of(gl, cloth_look(scene, index, has_coordinates), scene.cloths[index].appearance);
}

BodyPaint collider_paint(const GlFunctions& gl, const Scene& scene, const Collider& collider) {
  return paint_of(gl, collider_look(scene, collider), collider.appearance);
}

}  // namespace weft::scenes
