#pragma once

#include <cstddef>
#include <optional>

#include <weft/scenes/scene.hpp>
#include <weft/scenes/step_commands.hpp>

namespace weft::scenes {

/// Switches the level of detail of one cloth, see Detail: at the times of its list, or when a program
/// says so. With g(t) the animated places, taken as moving evenly within a step,
///   kSimplified  x'' = -w^2 (x - g) - 2 w (x' - g'),  w = 2 pi follow, solved exactly: no step is too
///                long; limits of the cloth's positions hold, pinned nodes are at their places
///   kSkin        x = g + o(s), o the cubic with o(0) = x - g and o'(0) = x' - g' at the switch and
///                both 0 after the time of blending
/// so that a switch never moves a node and never changes its velocity at once. Back in kFull the
/// engine goes on from where the nodes are. The animation knew neither colliders nor taut springs; what
/// they want now comes slowly: during the time of blending, with s from 0 to 1, a node's acceleration is
/// at most kReleaseAcceleration s / (1 - s), instead of the cloth's own limits.
class DetailController final : public Controller {
 public:
  /// cloth: number of detail.cloth in its scene. Throws InvalidArgument for values out of their
  /// domain, for times that do not grow and for a cloth that tears.
  DetailController(const Detail& detail, std::size_t cloth, const Cloth& description);

  static constexpr double kReleaseAcceleration = 100.0;  ///< [m/s^2], some ten times gravity

  /// From the next step on, until the next time of the list.
  void set_level(DetailLevel level) { level_ = level; }
  [[nodiscard]] DetailLevel level() const { return level_; }

  void steer(const SceneState& state, double end_time, StepCommands& commands) override;
  void serialize(StateArchive& archive) override;

 private:
  /// What the animated places of a step are measured against.
  struct Goal {
    Matrix3X<double> start;     ///< 3 x n [m]
    Matrix3X<double> end;       ///< 3 x n [m]
    Matrix3X<double> velocity;  ///< 3 x n [m/s]
  };
  void leave_full(const ClothState& cloth);
  void follow_list(double end_time);
  [[nodiscard]] Matrix3X<double> pins_at_end(const ClothState& cloth, double time_step,
                                             const ClothCommands& lead) const;
  void carry(const Matrix3X<double>& pins);
  [[nodiscard]] Goal goal_of(const ClothState& cloth, double time_step, const ClothCommands& lead);
  [[nodiscard]] Placement simplified(const ClothState& cloth, const Goal& goal,
                                     double time_step) const;
  void begin_blending(const ClothState& cloth, const Goal& goal);
  [[nodiscard]] Placement blended(const Goal& goal) const;
  void place(const ClothState& cloth, double time_step, ClothCommands& lead);
  void release(const ClothState& cloth, double time_step, ClothCommands& lead);

  Detail detail_;
  std::size_t cloth_;
  std::vector<int> pinned_;
  Matrix3X<double> pinned_velocities_;  ///< of the mesh [m/s]
  std::size_t next_switch_ = 0;
  DetailLevel level_ = DetailLevel::kFull;
  DetailLevel last_level_ = DetailLevel::kFull;

  Matrix3X<double> last_animated_;  ///< 3 x n [m], at the end of the last step; empty: none
  Matrix3X<double> shape_;          ///< 3 x n [m], carried by the pins
  Matrix3X<double> shape_pins_;     ///< the pins of that shape [m]
  Matrix3<double> turn_;            ///< of the shape since then

  double blended_ = 0.0;            ///< [s] since the last switch, of those that are blended
  Matrix3X<double> offset_;         ///< 3 x n [m], at that switch
  Matrix3X<double> offset_change_;  ///< 3 x n [m/s], likewise
};

}  // namespace weft::scenes
