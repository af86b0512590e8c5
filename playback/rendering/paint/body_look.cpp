#include <weft/playback/rendering/paint/body_look.hpp>

#include <weft/core/error.hpp>
#include <weft/playback/rendering/paint/color_map.hpp>
#include <weft/playback/rendering/paint/palette.hpp>
#include <weft/playback/rendering/paint/pattern.hpp>
#include <weft/scenes/format/scene_file.hpp>

namespace weft::scenes {
namespace {

constexpr int kSimpleSize = 512;   // [pixel]
constexpr int kDetailSize = 1024;  // [pixel]

std::optional<Image> picture_of(const Scene& scene, const Appearance& appearance,
                                const Rgb& body_color) {
  if (!appearance.image.empty()) {
    const std::optional<std::string> bytes = files_of(scene)(appearance.image);
    if (!bytes) {
      throw InvalidArgument("texture '" + appearance.image +
                            "': not among the scene's files, expected it there");
    }
    return decode_image(*bytes);
  }
  if (appearance.pattern == Pattern::kPlain) return std::nullopt;
  PatternColors colors = default_colors(appearance.pattern, body_color);
  if (appearance.pattern_color) colors.figure = *appearance.pattern_color;
  const bool has_detail =
      appearance.pattern == Pattern::kCarpet || appearance.pattern == Pattern::kEyeball;
  return pattern_image(appearance.pattern, colors, has_detail ? kDetailSize : kSimpleSize);
}

/// The mapping is that of a body with coordinates.
BodyLook look_of(const Scene& scene, const Appearance& appearance, const Rgb& color) {
  BodyLook look;
  look.front = color;
  look.picture = picture_of(scene, appearance, color);
  if (!look.picture) return look;
  look.mapping = appearance.pattern == Pattern::kEyeball && appearance.image.empty()
                     ? TextureMapping::kFromFront
                     : TextureMapping::kByCoordinates;
  return look;
}

/// The other side of a dyed cloth: paler and warmer.
Eigen::Vector3f back_of(const Rgb& front) {
  return 0.45f * linear_light(front) + 0.55f * linear_light({236, 222, 196});
}

}  // namespace

BodyLook cloth_look(const Scene& scene, std::size_t index, bool has_coordinates) {
  const Appearance& appearance = scene.cloths[index].appearance;
  const ClothColors& palette = kClothPalette[index % kClothPalette.size()];
  const Rgb color = appearance.color.value_or(palette.front);
  BodyLook look = look_of(scene, appearance, color);
  if (look.mapping == TextureMapping::kByCoordinates && !has_coordinates) {
    look.mapping = TextureMapping::kByDirection;
  }
  look.back = appearance.back_color ? linear_light(*appearance.back_color)
              : appearance.color    ? back_of(color)
                                    : linear_light(palette.back);
  look.texture_on_back = !appearance.back_color;
  return look;
}

BodyLook collider_look(const Scene& scene, const Collider& collider) {
  const Appearance& appearance = collider.appearance;
  const bool is_moving = collider.mass.has_value();
  const Rgb color =
      appearance.color.value_or(is_moving ? kMovingBodyColors.front : kFixedBodyColor);
  BodyLook look = look_of(scene, appearance, color);
  look.back = linear_light(is_moving ? kMovingBodyColors.back : color);
  look.is_two_tone = is_moving && !appearance.color && look.mapping == TextureMapping::kNoTexture &&
                     std::holds_alternative<SphereShape>(collider.shape);
  look.texture_on_back = true;
  return look;
}

}  // namespace weft::scenes
