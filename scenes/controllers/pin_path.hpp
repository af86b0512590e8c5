#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <weft/scenes/scene.hpp>
#include <weft/scenes/steering.hpp>

namespace weft::scenes {

/// Leads the pins of a cloth, those that follow paths and the others. The frame of a path stands at
/// its point of time 0 at the start, turned as it is then; each node keeps its place in it:
///   x(t) = p(t) + R(t) R(0)^T (x0 - p(0)).
class PinPathController final : public Controller {
 public:
  /// cloth: number of the cloth in its scene.
  PinPathController(const Cloth& cloth, std::size_t index);

  void steer(const SceneState& state, double end_time, Steering& steering) override;

 private:
  struct Lead {
    PathMotion motion;
    Pose start;
  };
  std::size_t cloth_;
  Matrix3X<double> rest_positions_;  ///< of the pinned nodes [m]
  Matrix3X<double> velocities_;      ///< of those without a path [m/s]
  std::vector<Lead> leads_;
  std::vector<std::optional<std::size_t>> lead_of_;  ///< of each pinned node
};

/// Where a node is that keeps its place in a frame: place + R R0^T (x0 - p0).
[[nodiscard]] Vector3<double> carried(const Pose& start, const Pose& now,
                                      const Vector3<double>& rest_position);

}  // namespace weft::scenes
