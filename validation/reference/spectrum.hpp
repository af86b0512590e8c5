#pragma once

#include <weft/validation/reference/system.hpp>

namespace weft::reference {

/// The stiffest and the most damped motion of a body, linearised at its present state.
/// K = -df/dx, C = -df/dv, free nodes only. M is the mass matrix; for a body with inertia-level laws,
/// whose forces are redistributed by R, it stands for M R^-1 except with velocity-level laws.
struct Spectrum {
  double omega_max = 0.0;           ///< root of the largest eigenvalue of M^-1/2 K M^-1/2 [rad/s]
  double top_mode_damping = 0.0;    ///< phi . C phi / phi . M phi of that mode, all laws [1/s]
  double gamma_force_max = 0.0;     ///< largest eigenvalue of M^-1 C, laws that act as forces [1/s]
  double gamma_velocity_max = 0.0;  ///< the same for velocity-level laws [1/s]
  int iterations = 0;               ///< of the longest of the three power iterations
  bool converged = true;            ///< all three
};

/// Relative change of the Rayleigh quotient at which power iteration stops. The error of omega_max
/// is larger where the next modes are close: 1e-6 for small meshes, 3e-6 measured on a 30 x 30
/// lattice.
inline constexpr double kRayleighTolerance = 1e-8;
inline constexpr int kMaxPowerIterations = 5000;

/// Matrix-free power iteration from a fixed start vector: the same bits every time. Approaches from
/// below. A negative eigenvalue (a compressed spring) may dominate; the iteration is then shifted
/// so that the largest positive one is found.
[[nodiscard]] Spectrum spectrum(Body& body);

}  // namespace weft::reference
