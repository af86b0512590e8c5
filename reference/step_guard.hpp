#pragma once

#include <string>

#include <weft/reference/options.hpp>
#include <weft/reference/spectrum.hpp>

namespace weft::reference {

/// Largest step [s] at which no mode of a body with this spectrum grows; infinity if nothing moves
/// it, 0 if none. w = omega_max, f = gamma_force_max, g = gamma_velocity_max.
/// A mode is x'' = -w^2 x - (f + g) x'. Inertia-level laws lower w and f: acceleration_damping makes
/// an undamped step sqrt(1 + beta) times as long.
///
///   modified Euler   forces::critical_time_step(), exact
///   Verlet           h^2 w^2 + 2 h f < 4
///       exact for f = 0, for every g, since the velocity-level laws are exact; conservative for
///       f > 0, where the scheme's own bound is h^2 w^2 < 4 - 2 h f + h^2 f^2, h f < 2.
///   Runge-Kutta 4    h w < 2.828 undamped; h max(w, f + g) < 2.615 damped
///       the stability region holds 2.828 of the imaginary axis and the left half disc of radius
///       2.615; no eigenvalue -(f + g)/2 +- root is larger in magnitude than max(w, f + g).
///   explicit Euler   h < min(d / w^2, 2 / (f + g)),  d = top_mode_damping; so 0 undamped
///       |1 + h lambda| < 1. Exact for an underdamped body whose damping is Rayleigh's (a mass part
///       plus a stiffness part: velocity_damping plus spring_damping in step with tension), where
///       the top mode is the first to grow; for other damping an estimate.
///   Yoshida 4        h w < 1.573 undamped; h max(w, f + g) < 1.36 damped
///       the first is exact; the second is the largest such box in which trace and determinant of the
///       propagation matrix of an oscillator pass the Jury criterion, by a scan of w and f + g.
///   Dormand-Prince   infinity: it shortens its own inner steps
///   implicit methods infinity: A-stable, so no mode of a stable spring network grows
[[nodiscard]] double stable_step(IntegratorKind integrator, const Spectrum& spectrum);

/// Radius of the largest left half disc in the stability region of the classical Runge-Kutta method
/// [-], rounded down; and its bound on the imaginary axis, 2 sqrt 2.
inline constexpr double kRungeKuttaHalfDisc = 2.615;
inline constexpr double kRungeKuttaImaginary = 2.8284271247461900;
/// Bounds of Yoshida's method [-], rounded down.
inline constexpr double kYoshidaUndamped = 1.5734;
inline constexpr double kYoshidaDamped = 1.36;

/// What the guard found.
struct Stability {
  double stable_step = 0.0;  ///< [s], of the body that allows the least; may be infinite
  std::string body;          ///< its name
  Spectrum spectrum;         ///< and its spectrum
};

[[nodiscard]] Stability assess(System& system, IntegratorKind integrator);

/// Part of the stable step that substeps use [-]: power iteration comes from below, and springs
/// stiffen.
inline constexpr double kSubstepSafety = 0.9;
/// More substeps than this are a mistake in the scene.
inline constexpr int kMaxSubsteps = 10000;

/// Number of equal substeps of time_step [s] under a policy: 1, or for kSubstep the smallest number
/// that keeps the safety. Throws InvalidArgument for kRefuse and a step beyond the stable one, and
/// for kSubstep where no number up to kMaxSubsteps is enough.
[[nodiscard]] int num_substeps(GuardPolicy policy, const Stability& stability, double time_step);

}  // namespace weft::reference
