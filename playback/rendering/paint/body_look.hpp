#pragma once

// Tested by tests/playback/rendering/appearance_render_test.cpp, tests/playback/exchange/gltf/gltf_export_test.cpp.

#include <optional>

#include <weft/playback/rendering/image.hpp>
#include <weft/scenes/scene.hpp>

namespace weft::scenes {

/// Where in its picture a place of a body is; as in surface.frag.
enum class TextureMapping {
  kNoTexture,
  kByCoordinates,  ///< texture coordinates
  kByDirection,    ///< longitude and latitude of the place at rest, seen from the middle
  kFromFront,      ///< angle from the body's z axis, as Pattern::kEyeball
};

/// The colors and the picture of a body, for whatever draws it.
struct BodyLook {
  Rgb front{255, 255, 255};
  Eigen::Vector3f back{1, 1, 1};  ///< linear light
  TextureMapping mapping = TextureMapping::kNoTexture;
  std::optional<Image> picture = {};  ///< none: TextureMapping::kNoTexture
  bool texture_on_back = false;
  bool is_two_tone = false;  ///< octants in both colors, which show how a plain ball turns
};

/// index chooses from the palette; has_coordinates: whether the mesh has texture coordinates. Throws InvalidArgument for a picture that is
/// not among the scene's files.
[[nodiscard]] BodyLook cloth_look(const Scene& scene, std::size_t index, bool has_coordinates);
[[nodiscard]] BodyLook collider_look(const Scene& scene, const Collider& collider);

}  // namespace weft::scenes
