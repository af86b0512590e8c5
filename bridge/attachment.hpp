#pragma once

#include <memory>
#include <optional>
#include <vector>

#include <BulletSoftBody/btSoftBody.h>

#include <weft/bridge/fast_body.hpp>
#include <weft/bridge/rigid_response.hpp>
#include <weft/bridge/solver.hpp>
#include <weft/custom_forces/deferred_forces.hpp>

// Not for users of the bridge: what SoftBodySolver knows of its bodies.
namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

struct SoftBodySolver::Attachment {
  btSoftBody* body;
  forces::LawSet<btScalar> laws;
  forces::DeferredForces<btScalar> deferred{laws,
                                            forces::LawSet<btScalar>::VelocityLaws::kSeparate};
  VectorX<btScalar> masses;
  DampingPlace damping = DampingPlace::kAutomatic;
  Matrix3X<btScalar> start_velocities;  // of the step, only for inertia after the projection
  Matrix3X<btScalar> positions;
  Matrix3X<btScalar> velocities;
  Matrix3X<btScalar> forces;
  std::optional<BodyBlowUp> blow_up;
  PositionLimits limits;
  std::unique_ptr<FastBody> fast;  // none: Bullet's own constraints
  ContactResponse contact_response = ContactResponse::kCoulomb;
  RigidResponse rigid_response;
  bool was_in_world = false;
  bool is_suspended = false;
  double time = 0.0;  // [s] of the steps since the body was attached

  [[nodiscard]] bool has_coulomb_contacts() const {
    return !fast && contact_response == ContactResponse::kCoulomb && RigidResponse::fits(*body);
  }
  [[nodiscard]] bool acts_after_projection(forces::LawTraits::Level level) const;
  /// Forces, and what FastBody does with them.
  void predict(btScalar time_step);
  void add_forces(btScalar time_step);
  [[nodiscard]] bool add_forces_node_by_node(btScalar time_step);
  void begin_forces();
  void sum_laws();
  void damp_velocities(btScalar time_step);
  void slow_down_changes();
  void check_laws();
};

struct ContactEntry {
  btSoftBody* body;
  ClothContact contact;
  bool was_in_world = false;
  std::vector<btVector3> solved;  ///< [m] places of the nodes when the body itself was solved

  void remember_solution();
  /// What moved nodes afterwards, the contacts of other bodies, becomes part of their velocities.
  void add_later_motion();
  /// The same where velocities are differences of places, as Bullet's own: with Bullet's rounding.
  void derive_velocities();
};

struct SoftBodySolver::Attachments {
  std::vector<std::unique_ptr<Attachment>> list;
  std::vector<Attachment*> stepped;        ///< fast bodies of the present step
  std::vector<Attachment*> asked;          ///< of those, that contacts are still looked for
  std::vector<const btRigidBody*> pushed;  ///< once for each of those that may push it, in order
  std::vector<std::unique_ptr<ContactEntry>> contacts;
  HullTable hulls;  ///< of rigid objects that bodies have met
};

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
