#pragma once

// Tested by tests/playback/exchange/gltf/gltf_export_test.cpp.

#include <map>
#include <string>

#include <weft/playback/exchange/gltf/glb_writer.hpp>
#include <weft/playback/rendering/paint/body_look.hpp>
#include <weft/scenes/scene.hpp>

namespace weft::scenes {

/// The materials and pictures of a glTF document. Bodies that look alike share them.
class GltfMaterials {
 public:
  /// Both must outlive it.
  GltfMaterials(GlbWriter& writer, const Scene& scene) : writer_(writer), scene_(scene) {}

  /// Index of a two-sided material with the front's color, or with the picture if the look has one. appearance: of the same body.
  int add(const BodyLook& look, const Appearance& appearance);
  /// Index of a two-sided material of one color, linear light.
  int add_color(const Eigen::Vector3f& color);

 private:
  int add_texture(const BodyLook& look, const Appearance& appearance);
  int add_material(GltfJson surface);

  GlbWriter& writer_;
  const Scene& scene_;
  std::map<std::string, int> textures_;   ///< by the bytes of the picture
  std::map<std::string, int> materials_;  ///< by the text of the surface
};

/// Where a body's picture lies, as glTF counts: v from the top of the picture downwards, with the repetitions of the appearance. place: 2 x n, as Weft counts.
[[nodiscard]] Eigen::Matrix2Xf gltf_coordinates(const Eigen::Matrix2Xf& place,
                                                const Appearance& appearance);

/// Where in the picture a place of a body is, seen from the body's middle at rest; for the mappings that need no texture coordinates.
[[nodiscard]] Eigen::Vector2d place_in_picture(TextureMapping mapping,
                                               const Vector3<double>& from_middle);
/// The same for each corner of each triangle, 2 x 3t. A triangle over the seam of kByDirection goes on beyond the picture's border, where the picture
/// repeats.
[[nodiscard]] Matrix2X<double> corner_places(TextureMapping mapping, const ClothMesh& mesh);

}  // namespace weft::scenes
