#include <weft/scenes/characters/start_state.hpp>

#include <algorithm>

namespace weft::scenes {
namespace {

constexpr double kStartShare = 1e-5;  ///< of the largest cloth's size [-]

/// [s] Over which the velocity of the animation at the start is taken: far below a frame, and the
/// difference of places of some metres still has twelve digits.
constexpr double kVelocityInterval = 1e-3;

}  // namespace

StartState start_state(const Cloth& cloth, const ClothMesh& mesh) {
  const auto* skin = std::get_if<SkinSource>(&cloth.source);
  if (skin == nullptr) {
    return {mesh.rest_positions, cloth.velocity.replicate(1, mesh.num_nodes())};
  }
  StartState state;
  state.positions = skin_positions(*skin, 0.0);
  state.velocities =
      (skin_positions(*skin, kVelocityInterval) - state.positions) / kVelocityInterval;
  return state;
}

double start_tolerance(const Scene& scene) {
  double size = 0.0;
  for (const Cloth& cloth : scene.cloths) size = std::max(size, body_size(cloth.source));
  return kStartShare * size;
}

}  // namespace weft::scenes
