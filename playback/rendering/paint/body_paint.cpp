#include <weft/playback/rendering/paint/body_paint.hpp>

#include <algorithm>

#include <weft/core/error.hpp>
#include <weft/playback/rendering/paint/palette.hpp>
#include <weft/scenes/format/scene_file.hpp>

namespace weft::scenes {
namespace {

// From EXT_texture_filter_anisotropic; core OpenGL only since 4.6. Without it a picture that is seen
// at a glancing angle is blurred.
constexpr GLenum kMaxAnisotropy = 0x84FE;

constexpr int kSimpleSize = 512;   // [pixel]
constexpr int kDetailSize = 1024;  // [pixel]

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

/// Colours and texture of an appearance; the mapping is that of a body with coordinates.
void apply(const GlFunctions& gl, const Scene& scene, const Appearance& appearance,
           const Rgb& body_color, BodyPaint& paint) {
  paint.is_flat = !appearance.smooth;
  paint.is_visible = appearance.visible;
  paint.repeat = {static_cast<float>(appearance.texture_repeat[0]),
                  static_cast<float>(appearance.texture_repeat[1])};
  if (!appearance.image.empty()) {
    const std::optional<std::string> bytes = files_of(scene)(appearance.image);
    if (!bytes) {
      throw InvalidArgument("texture '" + appearance.image +
                            "': not among the scene's files, expected it there");
    }
    paint.texture = upload(gl, decode_image(*bytes));
  } else if (appearance.pattern != Pattern::kPlain) {
    PatternColors colors = default_colors(appearance.pattern, body_color);
    if (appearance.pattern_color) colors.figure = *appearance.pattern_color;
    const bool has_detail =
        appearance.pattern == Pattern::kCarpet || appearance.pattern == Pattern::kEyeball;
    paint.texture = upload(
        gl, pattern_image(appearance.pattern, colors, has_detail ? kDetailSize : kSimpleSize));
  }
  if (paint.texture == 0) return;
  paint.mapping = appearance.pattern == Pattern::kEyeball && appearance.image.empty()
                      ? BodyPaint::Mapping::kFromFront
                      : BodyPaint::Mapping::kByCoordinates;
}

/// The other side of a dyed cloth: paler and warmer.
Eigen::Vector3f back_of(const Rgb& front) {
  return 0.45f * linear_light(front) + 0.55f * linear_light({236, 222, 196});
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
  const Appearance& appearance = scene.cloths[index].appearance;
  const ClothColors& palette = kClothPalette[index % kClothPalette.size()];
  const Rgb color = appearance.color.value_or(palette.front);
  BodyPaint paint;
  apply(gl, scene, appearance, color, paint);
  if (paint.mapping == BodyPaint::Mapping::kByCoordinates && !has_coordinates) {
    paint.mapping = BodyPaint::Mapping::kByDirection;
  }
  paint.front = linear_light(color);
  paint.back = appearance.back_color ? linear_light(*appearance.back_color)
               : appearance.color    ? back_of(color)
                                     : linear_light(palette.back);
  paint.texture_on_back = !appearance.back_color;
  return paint;
}

BodyPaint collider_paint(const GlFunctions& gl, const Scene& scene, const Collider& collider) {
  const Appearance& appearance = collider.appearance;
  const bool is_moving = collider.mass.has_value();
  const Rgb color =
      appearance.color.value_or(is_moving ? kMovingBodyColors.front : kFixedBodyColor);
  BodyPaint paint;
  apply(gl, scene, appearance, color, paint);
  paint.front = linear_light(color);
  paint.back = is_moving ? linear_light(kMovingBodyColors.back) : paint.front;
  paint.is_two_tone = is_moving && !appearance.color &&
                      paint.mapping == BodyPaint::Mapping::kNoTexture &&
                      std::holds_alternative<SphereShape>(collider.shape);
  paint.texture_on_back = true;
  return paint;
}

}  // namespace weft::scenes
