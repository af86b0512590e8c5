#pragma once

// Tested by tests/bridge/deformable/deformable_forces_test.cpp, tests/bridge/deformable/deformable_faults_test.cpp.

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include <weft/bridge/deformable/bullet_deformable.hpp>

#include <weft/bridge/bullet/bullet_guard.hpp>
#include <weft/bridge/classic/law_attachment.hpp>
#include <weft/core/state_archive.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

struct DeformableAttachment;

/// Weft's forces in Bullet's deformable world: one Lagrangian force that carries the laws of any
/// number of bodies. It comes with DeformableSolver; with Bullet's own solver it works in explicit
/// mode:
///
///   DeformableForces forces;
///   forces.add_to(solver);   // not world.addForce(), which merges forces by their type
///   forces.attach(*cloth, mesh, {{"tension", {}, {{"stiffness", {60.0}}}}});
///
/// Explicit step (h = time step, x, v = state at its start): the laws' total force is split as
///   f(x, v) = f(x, 0) + [f(x, v) - f(x, 0)].
/// The first part is applied explicitly, v* = v + h f(x, 0) / m; the bracket is Bullet's "damping
/// force", which Bullet solves implicitly and linearised: m (v' - v*) = h (f(x, v*) - f(x, 0) +
/// (df/dv) (v' - v*)). A law of x alone is in the first part only, a damper in the second only, and
/// a law that mixes both (wind) is split without loss or double count. For laws linear in v the
/// second part is backward Euler.
///
/// Implicit step: f(q, v') with q = x + h v', linearised with the exact df/dx and df/dv.
///
/// Forces on pinned nodes are not written: they move nothing, and Bullet's solver can leave its
/// constraints where they are. Bullet's m_f (btSoftBody::addForce), which this world ignores, acts
/// on bodies with laws for one step. A state that is not finite or too fast freezes the body
/// (DISABLE_SIMULATION) and is reported, as what a law throws does and is: Bullet would replace NaN by zero and clamp speeds.
/// In explicit mode too fast is a body diagonal per step, where Bullet clamps.
/// Masses are the body's own: setMass(), setTotalMass() and m_im act from the next step on.
/// Lifetime: a body that leaves its world, as Bullet tells, or is deleted, is forgotten. The object must outlive the solver's steps.
class DeformableForces : public btDeformableLagrangianForce {
 public:
  /// Throws Error if the calling program was compiled for another Bullet than the bridge.
  DeformableForces() : DeformableForces(bullet_layout_here()) {}
  ~DeformableForces() override;
  DeformableForces(const DeformableForces&) = delete;
  DeformableForces& operator=(const DeformableForces&) = delete;

  /// Joins the forces of a solver. repairs_implicit: the solver is one whose implicit step is sound
  /// (DeformableSolver); otherwise the first implicit step throws Error, for Bullet's own gives the
  /// nodes after a pinned one their neighbors' forces. Throws Error if it has joined already.
  void add_to(btDeformableBodySolver& solver, bool repairs_implicit = false);
  void remove_from(btDeformableBodySolver& solver);

  /// Makes the laws for the body's mesh and attaches them.
  /// Throws InvalidArgument as forces::make_law() and as the other attach().
  void attach(btSoftBody& body, const ClothMesh& mesh,
              const std::vector<forces::LawSpecification>& laws);
  /// masses: n [kg], > 0, those of pinned nodes too. Throws InvalidArgument if masses or laws do not
  /// fit the body's nodes, for a law of inertia level, if laws are attached already, for a timescale other than 1, and for a
  /// body that asks for what this world ignores: anchors of the classic world, wind, lift, drag,
  /// pressure, volume or pose forces, kDP; and for a body in a world that has another solver. The body must not gain or lose nodes afterwards.
  void attach(btSoftBody& body, forces::LawSet<btScalar> laws, VectorX<btScalar> masses);
  /// Does nothing if no laws are attached.
  void detach(btSoftBody& body);
  [[nodiscard]] bool has_laws(const btSoftBody& body) const { return find(body) != nullptr; }
  /// Set once the body has exploded; it does not move any more.
  [[nodiscard]] std::optional<BodyBlowUp> blow_up(const btSoftBody& body) const;
  /// Called once for each body that explodes, by the thread that steps the world: at the end of a step with
  /// DeformableSolver, at the start of the next one with Bullet's own solver. It must not throw: that ends the
  /// program (std::terminate). Empty: nobody is told.
  void set_on_blow_up(std::function<void(btSoftBody&, const BodyBlowUp&)> callback);

  /// Moves the laws' time on by time_step [s]; DeformableSolver does it after every step. With
  /// Bullet's own solver the time of laws with moving targets (drive) stands still otherwise.
  void advance_time(double time_step);

  /// Finds bodies that the prediction of a step of time_step [s] has made explode, before contact
  /// looks at where they would be: Bullet's distance field counts its cells in int, and reads beyond
  /// a cell where the count overflows. DeformableSolver does it in every implicit step.
  void find_explosions(btScalar time_step);

  void addScaledExplicitForce(btScalar scale, TVStack& force) override;
  void addScaledDampingForce(btScalar scale, TVStack& force) override;
  void addScaledForces(btScalar scale, TVStack& force) override;
  void addScaledElasticForceDifferential(btScalar scale, const TVStack& dx, TVStack& df) override;
  void addScaledDampingForceDifferential(btScalar scale, const TVStack& dv, TVStack& df) override;
  /// Adds the laws' own stiffness and damping to the nodes' effective mass, with which an implicit
  /// step predicts contact: m - h^2 df/dx - h df/dv, the 3 x 3 blocks of the diagonal, where they
  /// make the node heavier. Without it the prediction is an explicit step, and a stiff cloth hits a
  /// rigid body far too hard. Only for bodies attached with their mesh.
  void addScaledHessian(btScalar scale) override;
  /// Adds nothing: Bullet preconditions with it, and a mesh's damping diagonal is uniform enough for
  /// the masses alone to do.
  void buildDampingForceDifferentialDiagonal(btScalar /*scale*/, TVStack& /*diagonal*/) override {}
  double totalElasticEnergy(btScalar time_step) override;
  /// h R(v) with Rayleigh's R = -v (f(q, v) - f(q, 0)) / 2, whose gradient is the damping impulse.
  double totalDampingEnergy(btScalar time_step) override;
  void reinitialize(bool nodes_updated) override;
  void removeSoftBody(btSoftBody* body) override;  ///< Bullet's call for a body that leaves
  /// 0: none of Bullet's types, so that nothing is merged with it.
  btDeformableLagrangianForceType getForceType() override {
    return static_cast<btDeformableLagrangianForceType>(0);
  }

 private:
  friend void serialize(StateArchive& archive, DeformableForces& forces);
  explicit DeformableForces(const BulletLayout& caller);
  void forget_deleted();
  void tell_of_blow_ups() noexcept;
  [[nodiscard]] DeformableAttachment* find(const btSoftBody& body) const;
  [[nodiscard]] bool takes_part(const DeformableAttachment& attachment) const;
  void add_differential(btScalar scale, bool elastic, const TVStack& direction, TVStack& product);

  std::vector<std::unique_ptr<DeformableAttachment>> attachments_;
  std::function<void(btSoftBody&, const BodyBlowUp&)> on_blow_up_;
  const btDeformableBodySolver* solver_ = nullptr;
  bool repairs_implicit_ = false;
  bool solve_has_failed_ = false;  ///< in this step, and the body that made it fail is known
};

/// The memory that the laws have of the steps so far: time, followed masses, explosions. For bodies with the same
/// laws; the bodies themselves are not part of it.
void serialize(StateArchive& archive, DeformableForces& forces);

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
