#pragma once

// Tested by tests/bridge/solver_checks_test.cpp, tests/bridge/classic/body_life_test.cpp.

#include <exception>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <BulletSoftBody/btSoftBody.h>

#include <weft/bridge/adoption/followed_links.hpp>
#include <weft/bridge/classic/body_life.hpp>
#include <weft/bridge/cloth.hpp>
#include <weft/bridge/contact/cloth_pairs.hpp>
#include <weft/bridge/contact/rigid_response.hpp>
#include <weft/bridge/implicit/fast_body.hpp>
#include <weft/bridge/implicit/substeps/substep_count.hpp>
#include <weft/bridge/solver.hpp>
#include <weft/custom_forces/deferred_forces.hpp>

// Not for users of the bridge: what SoftBodySolver knows of its bodies.
namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

/// The mesh and the names that laws were made of; a torn body has none any more.
struct LawSource {
  ClothMesh mesh;
  std::vector<forces::LawSpecification> laws;
};

struct SoftBodySolver::Attachment {
  /// Throws InvalidArgument as SoftBodySolver::attach().
  Attachment(btSoftBody& of, forces::LawSet<btScalar> own_laws, VectorX<btScalar> own_masses,
             DampingPlace place);

  btSoftBody* body;
  std::shared_ptr<BodyLife> life;
  forces::LawSet<btScalar> laws;
  forces::DeferredForces<btScalar> deferred{laws,
                                            forces::LawSet<btScalar>::VelocityLaws::kSeparate};
  FollowedMasses followed;
  DampingPlace damping = DampingPlace::kAutomatic;
  Matrix3X<btScalar> start_velocities;  // of the step, only for inertia after the projection
  Matrix3X<btScalar> positions;
  Matrix3X<btScalar> velocities;
  Matrix3X<btScalar> forces;
  std::optional<BodyBlowUp> blow_up;
  bool is_reported = false;  // the blow-up, to SoftBodySolver::set_on_blow_up()
  bool is_moving = false;    // predicted, and the step has not ended yet
  bool has_ended = false;    // all that is due in the present step, by solve_alone()
  PositionLimits limits;
  std::unique_ptr<FastBody> fast;  // none: Bullet's own constraints
  FollowedLinks links;             // that springs of a fast body stand in for
  ContactResponse contact_response = ContactResponse::kCoulomb;
  RigidResponse rigid_response;
  std::vector<const btCollisionObject*> concave_met;  // in the present step
  bool was_in_world = false;
  bool is_suspended = false;
  double time = 0.0;                        // [s] of the steps since the body was attached
  std::shared_ptr<const LawSource> source;  // none: attached with a LawSet
  std::function<void(const std::vector<ClothContactPoint>&)> on_contact;  // as Cloth has them
  std::function<void(const BodyBlowUp&)> on_blow_up;

  [[nodiscard]] bool has_coulomb_contacts() const {
    return !fast && contact_response == ContactResponse::kCoulomb && RigidResponse::fits(*body);
  }
  [[nodiscard]] bool is_of(const btSoftBody& other) const {
    return body == &other && life->is_alive;
  }
  [[nodiscard]] const VectorX<btScalar>& masses() const { return followed.values(); }
  /// What the program has done to the body's masses since the last step.
  void follow_masses();
  /// The body stays where the step began.
  void stop(std::string reason);
  /// work(), whose exceptions stop the body: one that left Bullet's step in its middle would leave bodies that have been
  /// moved and others that have not.
  template <class Work>
  void guard(const Work& work) {
    try {
      work();
    } catch (const std::exception& error) {
      stop(error.what());
    } catch (...) {
      stop("an exception that is no std::exception");
    }
  }
  [[nodiscard]] bool acts_after_projection(forces::LawTraits::Level level) const;
  /// Begins a step of a fast body with what the program has done to it since the last one.
  void begin_fast_step();
  /// In a step: what the body's bounds meet. False for what is Bullet's to solve.
  bool collide(const btCollisionObjectWrapper& object, HullTable& hulls, btScalar time_step);
  /// Forces, and what FastBody does with them.
  void predict(btScalar time_step);
  void check_prediction();
  /// If a position or a velocity is not finite, nodes go back to where the step began, and blow_up says fault.
  void check_motion(const char* fault);
  /// The solution and all that follows it in the step, for a fast body that shares nothing with others (FastBody::is_alone()):
  /// one body after the other, its data are in the cache once.
  void solve_alone(btScalar time_step);
  void solve_by_stages(btScalar time_step);
  /// What is left to be done to velocities, once positions are solved for.
  void finish_velocities(btScalar time_step);
  /// Velocities and positions are final.
  void end_fast_step(btScalar time_step);
  void add_forces(btScalar time_step);
  [[nodiscard]] bool add_forces_node_by_node(btScalar time_step);
  void begin_forces();
  void sum_laws();
  void damp_velocities(btScalar time_step);
  void slow_down_changes();
};

struct ContactEntry {
  ContactEntry(btSoftBody& of, std::shared_ptr<BodyLife> own_life, ClothContact own_contact)
      : body(&of), life(std::move(own_life)), contact(std::move(own_contact)) {}

  btSoftBody* body;
  std::shared_ptr<BodyLife> life;
  ClothContact contact;
  bool was_in_world = false;
  bool is_in_contact = false;     ///< with itself or with other cloth, in this step
  bool was_in_contact = false;    ///< in the last one, or will be in this one
  bool is_by_flag = false;        ///< with others only where Bullet's VF_SS asks a fast body for it
  std::vector<btVector3> solved;  ///< [m] positions of the nodes when the body itself was solved

  [[nodiscard]] bool is_of(const btSoftBody& other) const {
    return body == &other && life->is_alive;
  }
  void begin_step() {
    contact.begin_step();
    was_in_contact = std::exchange(is_in_contact, false);
  }
  void remember_solution();
  /// What moved nodes afterwards, the contacts of other bodies, becomes part of their velocities.
  void add_later_motion();
  /// The same where velocities are differences of positions, as Bullet's own: with Bullet's rounding.
  void derive_velocities();
};

struct SoftBodySolver::Attachments {
  std::vector<std::unique_ptr<Attachment>> list;
  /// Where in the list each body was when note_order() was called, by the address of the body: find() need not look at all.
  std::vector<std::pair<const btSoftBody*, std::size_t>> order;
  std::vector<Attachment*> stepped;  ///< fast bodies of the present step
  std::vector<Attachment*> asked;    ///< of those, that contacts are still looked for
  std::vector<const void*> pushed;   ///< owners of inertia, once for each cloth that may push it
  std::vector<std::unique_ptr<ContactEntry>> contacts;
  ClothPairs pairs;  ///< of the present step, that are solved together
  std::function<void(btSoftBody&, const BodyBlowUp&)> on_blow_up;
  HullTable hulls;  ///< of rigid objects that bodies have met
  std::shared_ptr<FastBody::PreparedSolvers> prepared =
      std::make_shared<FastBody::PreparedSolvers>();

  [[nodiscard]] Attachment* find(const btSoftBody& body) const;
  void note_order();

  /// Has two bodies solved together in this step. False if one of them has no implicit springs, or is not stepped.
  bool add_pair(const Attachment* one, ClothContact& contact, const Attachment* other,
                ClothContact& other_contact);
  /// The same of bodies with themselves.
  void add_self_pairs();
  [[nodiscard]] ContactEntry* contact_of(const btSoftBody& body) const;
  /// Bodies that meet themselves are pairs, too; and which bodies will touch cloth in this step.
  void foresee_contacts(btScalar time_step);
  /// Into how many substeps a step is divided because the body touched cloth in the last one, or will do so.
  [[nodiscard]] int num_layer_substeps(const btSoftBody& body, btScalar time_step) const;
  [[nodiscard]] bool is_stepped(const btSoftBody& body) const;
  /// Pairs of bodies that have stopped, or are not stepped.
  void drop_stopped_pairs();
  /// Stops nodes and edges that would pass through cloth. Contacts are projected before that.
  void keep_layers_apart();
  /// Contacts with bodies of other solvers are those of the whole step.
  [[nodiscard]] bool meet_other_solvers() const;
  /// Pairs of bodies that are not stepped leave, and are returned.
  [[nodiscard]] ClothPairs take_other_pairs();
  /// Those that need the same substeps as this one, and how many.
  using Group = std::pair<std::vector<Attachment*>, int>;
  /// How the step of the stepped ones is divided.
  [[nodiscard]] SubstepPlan plan_of_stepped(int num_implicit, bool has_layers,
                                            btScalar time_step) const;
  [[nodiscard]] Group group_of(Attachment& first,
                               const std::function<int(const Attachment*)>& count) const;
  /// Solves the pairs again, with the impulses that they give each other.
  void share_cloth_impulses(btScalar time_step);
};

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
