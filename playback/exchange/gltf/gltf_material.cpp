#include <weft/playback/exchange/gltf/gltf_material.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include <weft/playback/rendering/image.hpp>
#include <weft/playback/rendering/paint/color_map.hpp>
#include <weft/scenes/format/scene_file.hpp>

namespace weft::scenes {
namespace {

// glTF's default is a metal. Cloth is rough; a ball that is a little smoother still shows its shape.
constexpr double kMetallic = 0.0;
constexpr double kRoughness = 0.8;

// Constants of OpenGL, as glTF has them.
constexpr int kLinear = 9729;
constexpr int kLinearMipmapLinear = 9987;

constexpr double kPi = std::numbers::pi;

/// Directions that are so near to the axis have no longitude.
constexpr double kNoLongitude = 1e-9;

bool is_jpeg(const std::string& bytes) {
  return bytes.starts_with("\xff\xd8\xff");
}

/// A JPEG goes along as it is. A PNG is written anew: where it is transparent, Weft shows white.
std::string picture_bytes(const Scene& scene, const BodyLook& look, const Appearance& appearance) {
  if (!appearance.image.empty()) {
    const std::optional<std::string> file = files_of(scene)(appearance.image);
    if (file && is_jpeg(*file)) return *file;
  }
  return encode_png(*look.picture);
}

}  // namespace

int GltfMaterials::add(const BodyLook& look, const Appearance& appearance) {
  if (!look.picture) return add_color(linear_light(look.front));
  const int texture = add_texture(look, appearance);
  return add_material({{"baseColorTexture", {{"index", texture}}}});
}

int GltfMaterials::add_color(const Eigen::Vector3f& color) {
  return add_material({{"baseColorFactor", {color[0], color[1], color[2], 1.0}}});
}

int GltfMaterials::add_texture(const BodyLook& look, const Appearance& appearance) {
  std::string bytes = picture_bytes(scene_, look, appearance);
  const auto known = textures_.find(bytes);
  if (known != textures_.end()) return known->second;
  // Without wrapping modes a picture repeats, as Weft's do.
  if (textures_.empty()) {
    writer_.add("samplers", {{"magFilter", kLinear}, {"minFilter", kLinearMipmapLinear}});
  }
  const int image = writer_.add_image(bytes, is_jpeg(bytes) ? "image/jpeg" : "image/png");
  const int texture = writer_.add("textures", {{"source", image}, {"sampler", 0}});
  textures_.emplace(std::move(bytes), texture);
  return texture;
}

int GltfMaterials::add_material(GltfJson surface) {
  surface["metallicFactor"] = kMetallic;
  surface["roughnessFactor"] = kRoughness;
  const auto [entry, is_new] = materials_.try_emplace(surface.dump(), 0);
  if (is_new) {
    entry->second = writer_.add(
        "materials", {{"pbrMetallicRoughness", std::move(surface)}, {"doubleSided", true}});
  }
  return entry->second;
}

Eigen::Matrix2Xf gltf_coordinates(const Eigen::Matrix2Xf& place, const Appearance& appearance) {
  Eigen::Matrix2Xf coordinates = place;
  coordinates.row(0) *= static_cast<float>(appearance.texture_repeat[0]);
  coordinates.row(1) *= static_cast<float>(appearance.texture_repeat[1]);
  coordinates.row(1) = 1.0f - coordinates.row(1).array();
  return coordinates;
}

Eigen::Vector2d place_in_picture(TextureMapping mapping, const Vector3<double>& from_middle) {
  const double length = from_middle.norm();
  if (length == 0.0) return {0.5, 0.5};
  const Vector3<double> direction = from_middle / length;
  if (mapping == TextureMapping::kFromFront) {
    // The point on the far side is the whole border of the picture; any place there will do.
    const double across = direction.head<2>().norm();
    const Eigen::Vector2d outwards =
        across > 0.0 ? Eigen::Vector2d(direction.head<2>() / across) : Eigen::Vector2d::UnitX();
    const double angle = std::acos(std::clamp(direction.z(), -1.0, 1.0));
    return Eigen::Vector2d::Constant(0.5) + 0.5 * angle / kPi * outwards;
  }
  return {std::atan2(direction.x(), direction.z()) / (2.0 * kPi) + 0.5,
          std::asin(std::clamp(direction.y(), -1.0, 1.0)) / kPi};
}

Matrix2X<double> corner_places(TextureMapping mapping, const ClothMesh& mesh) {
  const Vector3<double> middle = mesh.rest_positions.rowwise().mean();
  Matrix2X<double> places(2, mesh.triangles.size());
  for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
    std::optional<double> longitude;  // of the first corner that has one
    for (int pass = 0; pass < 2; ++pass) {
      for (int c = 0; c < 3; ++c) {
        const Vector3<double> from_middle = mesh.rest_positions.col(mesh.triangles(c, t)) - middle;
        Eigen::Vector2d place = place_in_picture(mapping, from_middle);
        const bool is_pole =
            std::hypot(from_middle.x(), from_middle.z()) <= kNoLongitude * from_middle.norm();
        if (mapping == TextureMapping::kByDirection && longitude) {
          place.x() = is_pole ? *longitude : place.x() - std::round(place.x() - *longitude);
        }
        if (!longitude && !is_pole) longitude = place.x();
        places.col(3 * t + c) = place;
      }
    }
  }
  return places;
}

}  // namespace weft::scenes
