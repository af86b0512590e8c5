#include <weft/playback/rendering/start_of_scene.hpp>

#include <utility>

#include <weft/scenes/characters/start_state.hpp>

namespace weft::scenes {

SceneState start_of_scene(const Scene& scene) {
  SceneState state;
  for (const Cloth& cloth : scene.cloths) {
    StartState start = start_state(cloth, make_mesh(cloth));
    state.cloths.push_back({cloth.name, std::move(start.positions), std::move(start.velocities)});
  }
  for (const Collider& collider : scene.colliders) {
    state.rigids.push_back({collider.name, collider.position, collider.orientation,
                            collider.velocity, collider.angular_velocity});
  }
  return state;
}

}  // namespace weft::scenes
