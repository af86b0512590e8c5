#pragma once

// Tested by tests/validation/theory_test.cpp.

#include <weft/scenes/scene.hpp>

namespace weft::validation {

/// A strip of hinges along x, clamped left of x = 0 by two columns of nodes.
struct StripScene {
  double length = 0.2;        ///< of its free part [m]
  int cells = 16;             ///< along that
  int rows = 3;               ///< of nodes across
  double area_density = 0.2;  ///< [kg/m^2]
  double rigidity = 1e-3;     ///< D [N m]
  double stiffness = 100.0;   ///< of springs along edges and diagonals [N/m]
  bool has_gravity = false;
  double rate = 0.0;  ///< of velocity_damping [1/s]
};

[[nodiscard]] ClothGrid strip_grid(const StripScene& strip);
[[nodiscard]] scenes::Cloth strip_cloth(const StripScene& strip);
/// A step that explicit springs and hinges stand, by Gershgorin's bound [s].
[[nodiscard]] double strip_step(const StripScene& strip);

}  // namespace weft::validation
