#pragma once

// Tested by tests/scenes/characters_test.cpp.

#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <weft/mesh/position_limits.hpp>
#include <weft/scenes/appearance/appearance.hpp>
#include <weft/scenes/characters/skin_source.hpp>

namespace weft::scenes {

/// Where the artist painted how free a vertex is, 0 to 1.
struct PaintedColor {
  int channel = 0;  ///< of the vertex colours: red, green, blue, alpha
};
struct PaintedGroup {
  std::string bone;  ///< whose weight on the vertex counts
};
using Paint = std::variant<PaintedColor, PaintedGroup>;

/// How far a vertex may leave its animated place.
struct ReachSettings {
  std::optional<double> max_distance = std::nullopt;  ///< [m], >= 0; none: any distance
  /// A vertex painted 0 is attached, one painted w may go w max_distance far.
  std::optional<Paint> paint = std::nullopt;
  double backstop_radius = 0.0;  ///< [m], >= 0; 0: no backstop
  double backstop_offset = 0.0;  ///< [m], >= 0
};

/// A part of a character that is simulated.
struct CharacterCloth {
  std::string part;   ///< in the model
  std::string cloth;  ///< in the scene
  ReachSettings reach;
};

/// A collider that a bone leads.
struct CharacterCollider {
  std::string bone;
  std::string collider;  ///< in the scene
  Pose place;            ///< in the bone's frame [m]
};

/// A rigged model: its cloths, skins and colliders stand among those of the scene, and it leads them.
struct CharacterSettings {
  std::string name;
  std::shared_ptr<const CharacterModel> model;
  CharacterPose pose;
  std::vector<CharacterCloth> cloths;
  std::vector<std::string> skins;  ///< cloths of the scene that are drawn only
  Appearance appearance;           ///< of the skins
  std::vector<CharacterCollider> colliders;
};

/// Largest distance of each vertex from its animated place, n [m]; infinity where there is none. Throws
/// InvalidArgument for a paint that the part does not have.
[[nodiscard]] VectorX<double> max_distances(const ReachSettings& reach, const SkinSource& source);

}  // namespace weft::scenes
