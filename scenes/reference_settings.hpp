#pragma once

// Tested by tests/scenes/format/scene_file_test.cpp.

namespace weft::scenes {

/// How the reference solver steps (docs/reference_solver.md), in the order of its own list.
enum class Integrator {
  kExplicitEuler,
  kModifiedEuler,
  kVelocityVerlet,
  kRungeKutta4,
  kYoshida4,
  kDormandPrince5,
  kImplicitEuler,
  kTrBdf2,
  kImplicitMidpoint,
  kGeneralizedAlpha,
};
enum class ContactModel { kProjection, kImpulse };
/// What of a cloth meets a collider.
enum class ContactPoints {
  kNodes,          ///< its nodes
  kNodesAndFaces,  ///< and its triangles: also a cloth that is coarser than the collider
};
/// What to do when the time step is beyond the stable one.
enum class StepGuard { kReport, kRefuse, kSubstep };

/// Settings of the reference solver.
struct ReferenceSettings {
  Integrator integrator = Integrator::kModifiedEuler;
  double tolerance = 1e-10;      ///< [-] of Dormand-Prince, relative, > 0
  double spectral_radius = 0.5;  ///< [-] of generalised alpha, 0 to 1
  ContactModel contact = ContactModel::kImpulse;
  ContactPoints contact_points = ContactPoints::kNodes;
  StepGuard step_guard = StepGuard::kReport;
};

}  // namespace weft::scenes
