#pragma once

// Tested by tests/reference/solver_test.cpp, tests/reference/damping_test.cpp.

#include <weft/reference/system.hpp>

namespace weft::reference {

/// Where the energy of a system is.
struct Energies {
  /// cloth and colliders with a mass [J]; with what inertia-level laws store, for
  /// acceleration_damping (beta / 2) sum m |v - v_c|^2
  double kinetic = 0.0;
  double potential = 0.0;  ///< stored by the laws, and M g X of colliders with a mass [J]
  /// non-conservative power of the laws [W]; negative: energy is lost. Velocity-level laws slow the
  /// added inertia down as well, which is part of it.
  double power = 0.0;
  [[nodiscard]] double total() const { return kinetic + potential; }
};

/// Contact impulses act on the plain masses and are not part of it: of a body with an inertia-level
/// law they change the stored kinetic energy as well.
/// time [s]: what the laws get to know as the time, for drive.
[[nodiscard]] Energies energies(const System& system, double time = 0.0);

/// Sum of m v over cloth nodes and colliders with a mass [kg m/s].
[[nodiscard]] Vector3<double> linear_momentum(const System& system);

/// About the origin, over cloth nodes and colliders with a mass [kg m^2/s].
[[nodiscard]] Vector3<double> angular_momentum(const System& system);

}  // namespace weft::reference
