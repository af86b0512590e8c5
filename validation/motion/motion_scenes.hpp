#pragma once

// Tested by tests/validation/motion/motion_figures_test.cpp, tests/validation/motion/swing_test.cpp.

#include <string>
#include <vector>

#include <weft/scenes/scene.hpp>

namespace weft::validation {

/// Scenes in which a solver that is excellent in stretch can be wrong in motion, in contact and at rest. Each is plain: springs, gravity,
/// drag and one collider, so that explicit integration in small steps tells what must happen. Time steps are 1/60 s; with_step() gives others.

/// A sheet of 1 m x 1 m that lies flat and is let go, held at two corners: 12 neighbors, equal masses, no damping, 3 s.
/// nodes: along an edge, >= 2; mass [kg]; stiffness [N/m] of each spring.
[[nodiscard]] scenes::Scene swinging_sheet(int nodes, double mass, double stiffness);

/// A limp sheet of 80 cm that stands on its edge, 1.1 degrees off the vertical, 3 s.
[[nodiscard]] scenes::Scene sheet_on_edge();
/// A sheet of 1 m that falls over a box of 20 x 40 x 20 cm, 3 s.
[[nodiscard]] scenes::Scene sheet_over_narrow_box();
/// A ball of 1 kg without friction in the middle of a sheet that is held all round; drag 20 1/s.
[[nodiscard]] scenes::Scene ball_on_trampoline(double duration);
/// A box of 1 kg that falls by 2 cm on a cloth that lies on a table, 2 s.
[[nodiscard]] scenes::Scene box_on_tablecloth();
/// A ball of 2 kg that is thrown on such a cloth at 4 m/s, 2 s.
[[nodiscard]] scenes::Scene ball_onto_tablecloth();
/// A ball of 0.2 kg that flies at 5 m/s into a sheet of 0.2 kg that hangs from its upper edge, 0.5 s.
[[nodiscard]] scenes::Scene ball_into_flag();
/// The same at 20 m/s into a stiff net that is held all round.
[[nodiscard]] scenes::Scene ball_into_net();

/// A ball of radius 10 cm that meets a free sheet of 80 cm and 128 g, nothing else acting, 0.3 s.
struct FreeImpact {
  double mass_ratio = 0.2 / 0.128;  ///< mass of the ball over that of the sheet, > 0
  double speed = 10.0;              ///< [m/s], > 0
};
[[nodiscard]] scenes::Scene ball_into_free_sheet(const FreeImpact& impact);

/// Sheets of 1 m and 250 g, held along two edges that come together to 80 cm, and along one edge; 12 s with drag.
[[nodiscard]] scenes::Scene hammock();
[[nodiscard]] scenes::Scene banner();
/// A sheet of 80 cm that has come to rest over a box and over a ball without touching the ground.
[[nodiscard]] scenes::Scene drape_over_box();
[[nodiscard]] scenes::Scene drape_over_ball();

/// A strip that is clamped at one end and hangs under its own weight.
struct Strip {
  std::string name;
  double length;         ///< [m]
  double width;          ///< [m]
  int nodes;             ///< along the length
  int rows;              ///< across
  double areal_density;  ///< [kg/m^2]
  double rigidity;       ///< D [N m]
  double duration;       ///< [s]
};
[[nodiscard]] scenes::Scene clamped_strip(const Strip& strip);
/// A stiff denim on a fine mesh, and four fabrics on ordinary ones.
[[nodiscard]] std::vector<Strip> typical_strips();

/// The same scene with another step [s], and a frame for every so many steps as are next to frame_interval [s].
[[nodiscard]] scenes::Scene with_step(scenes::Scene scene, double time_step, double frame_interval);

}  // namespace weft::validation
