#pragma once

// Tested by tests/reference/integrators_test.cpp, tests/reference/step_guard_test.cpp.

namespace weft::reference {

/// How one step advances positions and velocities (integrators/integrator.hpp).
enum class IntegratorKind {
  kExplicitEuler,     ///< order 1, unstable without damping: the negative control
  kModifiedEuler,     ///< order 1, velocity first: de Joya's scheme (2011), and Bullet's
  kVelocityVerlet,    ///< order 2
  kRungeKutta4,       ///< order 4
  kYoshida4,          ///< order 4, symplectic: long undamped runs without drift
  kDormandPrince5,    ///< order 5 with error control: as many steps within a step as it needs
  kImplicitEuler,     ///< order 1, damps all that it does not resolve
  kTrBdf2,            ///< order 2, L-stable: the implicit reference solution with damping
  kImplicitMidpoint,  ///< order 2, symplectic, keeps the energy of a linear system
  kGeneralizedAlpha,  ///< order 2, damps high frequencies as chosen (Chung and Hulbert 1993)
};

/// Whether a method moves positions with its end velocities: x1 = x0 + h v1.
[[nodiscard]] constexpr bool moves_with_end_velocity(IntegratorKind kind) {
  return kind == IntegratorKind::kModifiedEuler || kind == IntegratorKind::kImplicitEuler;
}

/// Numbers of methods that have a choice.
struct IntegratorSettings {
  /// Dormand-Prince: largest error of one inner step, as a part of the size of the body and of its
  /// largest speed [-], and beside that [m] and [m/s]. Both > 0.
  double relative_tolerance = 1e-10;
  double absolute_tolerance = 1e-12;
  /// Generalised alpha: what is left of an infinitely fast oscillation after a step [-], 0 to 1.
  double spectral_radius = 0.5;
};

/// What happens at a surface (contact/contact_model.hpp).
enum class ContactKind {
  kProjection,  ///< de Joya 2011: moved out to the surface, inward velocity removed, no friction
  kImpulse,     ///< velocity-level contact with exact Coulomb friction
};

/// What to do about a step beyond the stable one (step_guard.hpp).
enum class GuardPolicy {
  kReport,   ///< take it, and say so in the outcome
  kRefuse,   ///< throw InvalidArgument with both numbers
  kSubstep,  ///< divide it into equal substeps
};

struct SolverOptions {
  IntegratorKind integrator = IntegratorKind::kModifiedEuler;
  IntegratorSettings settings = {};
  ContactKind contact = ContactKind::kImpulse;
  GuardPolicy guard = GuardPolicy::kReport;
  /// Steps after which the stable step is estimated anew; 0: only at the first step. The estimate
  /// costs some hundred force evaluations.
  int guard_interval = 0;
};

}  // namespace weft::reference
