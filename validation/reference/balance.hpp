#pragma once

#include <weft/validation/reference/system.hpp>

namespace weft::reference {

/// Where the energy of a system is.
struct Energies {
  double kinetic = 0.0;    ///< cloth and colliders with a mass [J]
  double potential = 0.0;  ///< stored by the laws, and M g X of colliders with a mass [J]
  double power = 0.0;      ///< non-conservative power of the laws [W]; negative: energy is lost
  [[nodiscard]] double total() const { return kinetic + potential; }
};

/// time [s]: what the laws get to know as the time, for drive.
[[nodiscard]] Energies energies(const System& system, double time = 0.0);

/// Sum of m v over cloth nodes and colliders with a mass [kg m/s].
[[nodiscard]] Vector3<double> linear_momentum(const System& system);

/// About the origin, over cloth nodes and colliders with a mass [kg m^2/s].
[[nodiscard]] Vector3<double> angular_momentum(const System& system);

}  // namespace weft::reference
