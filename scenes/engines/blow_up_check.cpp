#include <weft/scenes/engines/blow_up_check.hpp>

#include <fmt/format.h>

namespace weft::scenes {

std::optional<BlowUp> first_blow_up(const SceneState& state, int step, double time) {
  for (const ClothState& cloth : state.cloths) {
    for (Eigen::Index i = 0; i < cloth.positions.cols(); ++i) {
      const int node = static_cast<int>(i);
      if (!cloth.positions.col(i).allFinite()) {
        return BlowUp{step, time, cloth.name, node, "position is not finite"};
      }
      const double speed = cloth.velocities.col(i).norm();
      if (speed <= kMaxNodeSpeed) continue;
      return BlowUp{step, time, cloth.name, node,
                    fmt::format("speed {:.3g} m/s is over {:.3g} m/s", speed, kMaxNodeSpeed)};
    }
  }
  return std::nullopt;
}

}  // namespace weft::scenes
