#pragma once

#include <span>
#include <string>
#include <vector>

#include <weft/scenes/scene.hpp>
#include <weft/validation/cases/support/sabotage.hpp>

namespace weft::validation {

/// Every collider moved by 8 cm.
[[nodiscard]] Sabotage body_moved();

/// Along each side: from here on a cloth may be too limp for its folds to come to rest in one place.
inline constexpr int kFoldingNodes = 26;

/// A cloth of 0.6 m x 0.6 m and one body that it comes to rest on.
struct CollisionScene {
  const char* id;             ///< "table_edge"
  const char* start;          ///< keys of the cloth: where it starts, what holds it
  const char* collider;       ///< the body, as TOML
  double friction = 0.0;      ///< of the contact [-]
  bool is_kinematic = false;  ///< the body follows a path, which bullet_deformable does not know
  bool slides = false;      ///< in sliding contact, which is not the same in Bullet's classic world
  double duration = 3.0;    ///< [s] until it is at rest
  double fine_drag = 4.0;   ///< [1/s] of velocity_damping from kFoldingNodes on; else 4 / s
  int finest_division = 4;  ///< the reference's shortest step is the scene's over this
  Sabotage (*early)() = &no_contact;       ///< a mistake that shows in the first half second
  Sabotage (*late)() = &body_moved;        ///< one that shows at rest
  void (*edit)(scenes::Scene&) = nullptr;  ///< what TOML is too long for
};

/// Sphere, cylinder, table edge, cone, box, capsule, mesh, led sphere, free ball, incline; then those that slide.
[[nodiscard]] std::span<const CollisionScene> collision_scenes();

/// The scene with so many nodes along each side, as a scene file has it.
[[nodiscard]] scenes::Scene written_collision_scene(const CollisionScene& scene, int nodes);
/// The same with Bullet's time step, as engines run it.
[[nodiscard]] scenes::Scene make_collision_scene(const CollisionScene& scene, int nodes);

}  // namespace weft::validation
