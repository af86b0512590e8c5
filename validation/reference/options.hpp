#pragma once

namespace weft::reference {

/// How one step advances positions and velocities (integrators/integrator.hpp).
enum class IntegratorKind {
  kExplicitEuler,   ///< order 1, unstable without damping: the negative control
  kModifiedEuler,   ///< order 1, velocity first: de Joya's scheme (2011), and Bullet's
  kVelocityVerlet,  ///< order 2
  kRungeKutta4,     ///< order 4
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
  ContactKind contact = ContactKind::kImpulse;
  GuardPolicy guard = GuardPolicy::kReport;
  /// Steps after which the stable step is estimated anew; 0: only at the first step. The estimate
  /// costs some hundred force evaluations.
  int guard_interval = 0;
};

}  // namespace weft::reference
