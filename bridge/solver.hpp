#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <BulletSoftBody/btDefaultSoftBodySolver.h>

#include <weft/bridge/bullet/bullet_guard.hpp>
#include <weft/bridge/classic/law_attachment.hpp>
#include <weft/bridge/contact/cloth_contact.hpp>
#include <weft/bridge/fast_settings.hpp>
#include <weft/bridge/step_error.hpp>
#include <weft/custom_forces/law_set.hpp>
#include <weft/mesh/cloth_mesh.hpp>
#include <weft/mesh/position_limits.hpp>

namespace weft {
struct Tear;
}  // namespace weft

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

class Cloth;
struct ContactEntry;
class FastBody;
struct TornLaws;
class WorldState;

/// Where the damping laws of a body act in Bullet's step: velocity-level laws (rotation_damping and
/// the like) and inertia-level laws (acceleration_damping). A force-driven body wants them before
/// Bullet integrates. A body that links hold together gets its velocities from the projection of
/// positions, so that damping before it is mostly undone by it.
enum class DampingPlace {
  /// Velocity-level laws after the projection; inertia before the integration, or, if the body has
  /// links, after the projection.
  kAutomatic,
  /// Before btSoftBody::predictMotion. Velocity-level laws add their forces, which needs a time step
  /// below 2 / rate; inertia redistributes the sum of the attached laws' other forces. Bullet's own gravity is uniform and needs nothing; other
  /// forces that Bullet adds (wind, pressure, m_f of the application) are not redistributed.
  kBeforeIntegration,
  /// After btSoftBody::solveConstraints, on m_v. First inertia: the change of velocity over the
  /// step, relative to that of the centre of mass, is divided (by 1 + beta). That change includes
  /// link and contact impulses; positions are not touched, so links and contacts hold as without it,
  /// but a node that was stopped by a surface keeps a part of its approach for the next step. Then
  /// the exact action of velocity-level laws.
  kAfterProjection,
};

/// How a body with laws and without links meets rigid objects.
enum class ContactResponse {
  kCoulomb,  ///< pushed to the surface and no farther, friction by Coulomb: RigidResponse
  kBullet,   ///< contacts from Bullet's distance fields, and Bullet's visits to them
};

/// A node of a body near a rigid object.
struct NodeContact {
  int node = 0;
  const btCollisionObject* object = nullptr;
  btVector3 normal{0, 0, 0};  ///< out of the object
  btScalar distance =
      0;  ///< [m] along the normal from where the object holds the node, its margin away; about 0: it touches
  btVector3 impulse{
      0, 0,
      0};  ///< of the object on the node, friction included [N s]; zero: near only, or solved by Bullet
  bool is_sticking = false;  ///< if it bears an impulse: held by friction, or sliding
};

/// Weft's forces in Bullet's classic soft-body world, through Bullet's own extension point.
///
///   SoftBodySolver solver;
///   btSoftRigidDynamicsWorld world(dispatcher, broadphase, constraints, configuration, &solver);
///   solver.attach(*cloth, mesh, {{"tension", {}, {{"stiffness", {60.0}}}}});
///
/// A body without attached laws is stepped by Bullet's default solver, bit for bit. For a body with
/// laws
/// * force-level laws are added to the nodes' m_f before btSoftBody::predictMotion,
/// * velocity-level and inertia-level laws act where DampingPlace says; by default velocity-level
///   laws act on m_v after btSoftBody::solveConstraints, for Bullet derives velocities from
///   positions there and would lose one that was written before,
/// * contacts with rigid objects are ContactResponse::kCoulomb, unless the body has links or clusters,
/// * a state that is not finite, or faster than kMaxSpeed, freezes the body and is reported (blow_up(),
///   set_on_blow_up()); Bullet would go on to look up contacts at that position and crash. So does an exception
///   of a law or a contact: none leaves stepSimulation() in the middle of a step.
///
/// Laws that move with time (drive) count it from the body's first step with laws, in the world's
/// steps.
/// The world's gravity (btSoftBodyWorldInfo::m_gravity) still acts: set it to zero for a body with
/// a gravity law.
/// Threads: num_threads() of core/parallel/threads.hpp; results do not depend on how many, nor on where they come from.
/// Masses are the body's own: setMass(), setTotalMass() and m_im act from the next step on.
/// Lifetime: laws belong to a body, not to its address. One that leaves its world keeps them until it comes
/// back; they end with detach() or with the body, which may be deleted at any time outside of a step.
/// For that the body's collision shape is one that follows its life from the first attach on (BodyLife).
class SoftBodySolver : public btDefaultSoftBodySolver {
 public:
  /// Throws Error if the calling program was compiled for another Bullet than the bridge.
  SoftBodySolver() : SoftBodySolver(bullet_layout_here()) {}
  ~SoftBodySolver() override;
  SoftBodySolver(const SoftBodySolver&) = delete;
  SoftBodySolver& operator=(const SoftBodySolver&) = delete;

  /// Speed [m/s] beyond which a node counts as exploded.
  static constexpr double kMaxSpeed = kBlowUpSpeed;

  /// Makes the laws for the body's mesh and attaches them. Throws InvalidArgument as check_mesh(),
  /// forces::make_law() and the other attach(), and for triangles that are not the body's faces.
  void attach(btSoftBody& body, const ClothMesh& mesh,
              const std::vector<forces::LawSpecification>& laws,
              DampingPlace damping = DampingPlace::kAutomatic);
  /// masses: n [kg], > 0, those of pinned nodes too (Bullet itself only knows that they do not move).
  /// Throws InvalidArgument if masses (to 1e-4) or laws do not fit the body's nodes, if laws are attached
  /// already, for a body in a world that has another solver, and for a body whose m_cfg.timescale is not
  /// 1: laws and Bullet would live in two times. Nothing has changed then.
  /// The body must not gain or lose nodes while laws are attached, but as replace_laws() says.
  void attach(btSoftBody& body, forces::LawSet<btScalar> laws, VectorX<btScalar> masses,
              DampingPlace damping = DampingPlace::kAutomatic);
  /// As attach(), with springs and their dampers solved implicitly instead of btSoftBody's own
  /// constraints (FastBody): stable at any time step, stiffness in N/m whatever the step. Damping laws
  /// act after the projection. Returns nothing if that was done, and else why the body cannot be stepped
  /// so: clusters, a pose to match, a timescale other than 1, links that no tension law stands in for.
  /// Nothing has changed then; attach(), with a step that it can take, is the program's own decision.
  /// Throws InvalidArgument as attach(), and for settings out of their domain.
  [[nodiscard]] std::optional<std::string> attach_fast(
      btSoftBody& body, const ClothMesh& mesh, const std::vector<forces::LawSpecification>& laws,
      const FastSettings& settings = {});
  /// Other settings for a body with attach_fast(). Throws InvalidArgument for a body without, and for settings
  /// out of their domain.
  void set_fast_settings(btSoftBody& body, const FastSettings& settings);
  [[nodiscard]] bool is_fast(const btSoftBody& body) const;
  /// Whether a fast body has come to rest and is not stepped (FastSettings::may_sleep).
  [[nodiscard]] bool is_asleep(const btSoftBody& body) const;
  /// Steps the body again. Only needed after changes that it cannot see: a law of the application's own.
  void wake(btSoftBody& body);
  /// How far the last step was solved. Throws InvalidArgument for a body without attach_fast().
  [[nodiscard]] StepError step_error(const btSoftBody& body) const;
  /// Contacts with rigid bodies and with cloth that the last step looked at.
  [[nodiscard]] int num_contacts(const btSoftBody& body) const;
  /// Those with rigid bodies, also of a body without laws. Bodies with laws leave btSoftBody::m_rcontacts empty;
  /// contacts with cloth are in m_scontacts. Distances are those of the nodes' present positions. Objects that
  /// have been deleted since the step are still named.
  [[nodiscard]] std::vector<NodeContact> rigid_contacts(const btSoftBody& body) const;
  /// Back to plain Bullet. Does nothing if no laws are attached.
  void detach(btSoftBody& body);
  /// Nodes were appended to a body, copies of these: its contact with cloth knows them from now on.
  void add_copies(const btSoftBody& body, const std::vector<int>& origins);
  /// Other laws for a body that has laws, and that may have gained nodes since (tearing.hpp). Its
  /// time goes on; where its damping acts stays; its position limits end. Throws InvalidArgument as attach(), and then
  /// nothing has changed; also for a body without laws.
  void replace_laws(btSoftBody& body, forces::LawSet<btScalar> laws, VectorX<btScalar> masses);
  /// The same from the laws' names, for a body with attach() or attach_fast(), which it stays: other
  /// parameters, or a torn mesh. A fast body is factorised anew in the next step.
  void replace_laws(btSoftBody& body, const ClothMesh& mesh,
                    const std::vector<forces::LawSpecification>& laws);
  /// Both for a tear, in time that goes by what it changes: laws_after() before the body is torn, with
  /// errors as make_laws(); replace_laws() when it has its new nodes.
  [[nodiscard]] TornLaws laws_after(const btSoftBody& body, const Tear& tear,
                                    const std::vector<forces::LawSpecification>& laws) const;
  void replace_laws(btSoftBody& body, const Tear& tear, TornLaws laws);
  [[nodiscard]] bool has_laws(const btSoftBody& body) const;
  /// A handle of the body, with laws or without (cloth.hpp).
  [[nodiscard]] Cloth cloth(btSoftBody& body);
  /// Set once the body has exploded; it does not move any more.
  [[nodiscard]] std::optional<BodyBlowUp> blow_up(const btSoftBody& body) const;
  /// Called once for each body that explodes, by the thread that steps the world, when the step's soft bodies
  /// are done. It may use this solver and the world, and must not throw: that ends the program (std::terminate),
  /// for the step is not over. Empty: nobody is told.
  void set_on_blow_up(std::function<void(btSoftBody&, const BodyBlowUp&)> callback);

  /// Limits on the positions of a body's nodes at the end of each of the following steps, until others
  /// are set; empty limits end them. They act after btSoftBody::solveConstraints, and so after links
  /// and contacts, and before damping (position_limits.hpp). Throws InvalidArgument for limits that do
  /// not fit the body and for a body without attached laws.
  void set_position_limits(btSoftBody& body, PositionLimits limits);

  /// Throws InvalidArgument for a body without attach().
  void set_contact_response(btSoftBody& body, ContactResponse response);

  /// Whether the body is stepped: suspended, it has no laws, links and contacts, and stays where it is
  /// or is put (place_body()); other bodies do not meet it. Going on, its first step starts from there;
  /// the clock of its laws has not stopped. Throws InvalidArgument for a body without attached laws.
  void set_suspended(btSoftBody& body, bool is_suspended);
  [[nodiscard]] bool is_suspended(const btSoftBody& body) const;

  /// Contact of the body with itself and with the others that have it too, see ClothContact. Made
  /// from the body's present shape as its rest shape; replaces what was set before. Bodies without
  /// it meet as Bullet's flags say; of two with VF_SS, one of them fast, likewise, with the margins of
  /// their shapes and the product of their kDF. Throws InvalidArgument for settings out of their domain.
  void set_cloth_contact(btSoftBody& body, const ClothContactSettings& settings);

  /// Deferred: the forces of the next step are started when a step ends, on other threads, and
  /// fetched when the next one begins; the time between belongs to the caller. Changes no bit: a
  /// body whose nodes were moved in between has its forces computed anew. Off at first.
  void set_deferred(bool is_deferred);
  /// How often forces that were started had to be computed anew, for something had moved the nodes.
  [[nodiscard]] long num_recomputed(const btSoftBody& body) const;

  void optimize(btAlignedObjectArray<btSoftBody*>& bodies, bool force_update = false) override;
  void predictMotion(btScalar time_step) override;
  void solveConstraints(btScalar time_step) override;
  void updateSoftBodies() override;
  void processCollision(btSoftBody* body, const btCollisionObjectWrapper* object) override;
  void processCollision(btSoftBody* body, btSoftBody* other) override;

 private:
  friend class Cloth;
  friend class WorldState;
  explicit SoftBodySolver(const BulletLayout& caller);
  struct Attachment;
  struct Attachments;
  [[nodiscard]] Attachment* find(const btSoftBody& body) const;
  [[nodiscard]] FastBody& fast_body(const btSoftBody& body) const;
  [[nodiscard]] ContactEntry* find_contact_entry(const btSoftBody& body) const;
  [[nodiscard]] ClothContact* find_contact(const btSoftBody& body) const;
  void settle_contact_velocities();
  void tell_of_each_other(btSoftBody& body, btSoftBody& other);
  [[nodiscard]] ContactEntry& contact_by_flag(btSoftBody& body);
  void notify_cloth(btSoftBody& body, btSoftBody& other);
  void for_bodies(const std::function<void(btSoftBody&, Attachment*)>& work);
  void solve_fast_bodies();
  void detect_contacts(btScalar time_step);
  void solve_in_substeps();
  void solve_group(const std::vector<Attachment*>& group, int num_implicit);
  void solve_listed_bodies(btScalar time_step);
  void solve_other_body(btSoftBody& body, Attachment* attachment);
  void tell_of_blow_ups() noexcept;
  [[nodiscard]] bool may_meet_cloth() const;
  void apply_listed_solutions(btScalar time_step, bool may_meet);
  /// Has exploded or is suspended.
  [[nodiscard]] bool is_still(const btSoftBody& body) const;

  std::unique_ptr<Attachments> attachments_;
  bool is_deferred_ = false;
  btScalar time_step_ = 0;  ///< [s] of the step in progress
};

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
