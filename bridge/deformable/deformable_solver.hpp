#pragma once

// Tested by tests/bridge/deformable/deformable_contact_test.cpp, tests/bridge/deformable/deformable_faults_test.cpp.

#include <weft/bridge/deformable/bullet_deformable.hpp>

#include <weft/bridge/deformable/deformable_forces.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

/// Settings that a cloth needs in the deformable world: nodes collide with rigid bodies through
/// their distance field, faces through GJK, and the body never sleeps. Throws InvalidArgument for a
/// cloth with links, which this world ignores.
void prepare_for_deformable_world(btSoftBody& body);

/// Bullet's deformable solver with Weft's forces in it and with repairs of what Bullet 3.24, 3.25
/// and its head get wrong:
///
/// * implicit mode: the forces that predict contact velocities were handed out by a counter that
///   skips pinned nodes, so that every node after the first pinned one got its neighbor's;
/// * implicit mode without a gravity force: an uninitialised vector was added to all velocities;
/// * implicit mode without world.setUseProjection(true): a preconditioner that does not exist was
///   used; here the projection is used in any case;
/// * a body without links whose constants are renewed (setMass and others) hung the program for
///   ever, in a tree that is built by joining neighbors;
/// * a node held by a deformable anchor kept an outdated trial position m_q.
///
///   DeformableSolver solver;
///   btDeformableMultiBodyConstraintSolver constraints;
///   constraints.setDeformableSolver(&solver);
///   btDeformableMultiBodyDynamicsWorld world(dispatcher, broadphase, &constraints, configuration,
///                                            &solver);
///   world.addSoftBody(cloth);
///   prepare_for_deformable_world(*cloth);
///   solver.forces().attach(*cloth, mesh, {{"tension", {}, {{"stiffness", {60.0}}}}});
class DeformableSolver : public btDeformableBodySolver {
 public:
  /// Throws Error if the calling program was compiled for another Bullet than the bridge.
  DeformableSolver() { forces_.add_to(*this, true); }
  DeformableSolver(const DeformableSolver&) = delete;
  DeformableSolver& operator=(const DeformableSolver&) = delete;

  [[nodiscard]] DeformableForces& forces() { return forces_; }
  [[nodiscard]] const DeformableForces& forces() const { return forces_; }

  /// Newton iterations of an implicit step; Bullet's fixed number is 1. Throws InvalidArgument for a
  /// number below 1.
  void set_newton_iterations(int iterations);

  void predictMotion(btScalar time_step) override;
  void applyExplicitForce() override;
  void setLagrangeMultiplier() override;
  void applyTransforms(btScalar time_step) override;

 private:
  void predict_positions(btScalar time_step);
  void add_gravity();
  void apply_predicting_impulses();

  DeformableForces forces_;
};

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
