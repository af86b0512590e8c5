#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <BulletSoftBody/btSoftBody.h>

#include <weft/bridge/bullet/precision.hpp>
#include <weft/bridge/classic/nodes/node_normals.hpp>
#include <weft/bridge/contact/backed_nodes.hpp>
#include <weft/bridge/contact/known_contacts.hpp>
#include <weft/bridge/contact/pinch.hpp>
#include <weft/bridge/contact/rigid_contacts.hpp>
#include <weft/bridge/contact/settled_nodes.hpp>
#include <weft/bridge/fast_settings.hpp>
#include <weft/bridge/implicit/bending_forces.hpp>
#include <weft/bridge/implicit/body_sleep.hpp>
#include <weft/bridge/implicit/history/force_history.hpp>
#include <weft/bridge/implicit/history/steady_step.hpp>
#include <weft/bridge/implicit/node_team.hpp>
#include <weft/bridge/implicit/stiffness_limit.hpp>
#include <weft/bridge/implicit/substeps/explicit_substeps.hpp>
#include <weft/bridge/implicit/substeps/substep_count.hpp>
#include <weft/bridge/rigid/coupled_bodies.hpp>
#include <weft/bridge/rigid/rigid_motion.hpp>
#include <weft/bridge/rigid/rigid_substeps.hpp>
#include <weft/bridge/rigid/sticking_points.hpp>
#include <weft/bridge/step_error.hpp>
#include <weft/custom_forces/law_info.hpp>
#include <weft/fast_solver/implicit_solver.hpp>
#include <weft/fast_solver/prepared_solvers.hpp>
#include <weft/mesh/cloth_mesh.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

/// Implicit springs for one btSoftBody of the classic world, instead of btSoftBody::solveConstraints. Bullet's bookkeeping stays:
/// nodes are predicted as by predictMotion(), m_q keeps positions at the start of the step, m_v follows from them, m_f is cleared.
///
/// Solved together: springs and dampers of the network, stabilised bending, anchors, contact with rigid
/// shapes and Coulomb friction. Contacts with cloth (m_scontacts) are projected afterwards, as Bullet does it. A dynamic body is
/// coupled with its inertia; at the end of the step it gets the impulses, and is moved by them. Bullet's own links are not looked at.
class FastBody : public NodeTeam {
 public:
  using PreparedSolvers = fast::PreparedSolvers<btScalar>;
  /// laws: all of the body's, of which those of springs and of bending are solved for here. masses: n [kg].
  /// Throws InvalidArgument as make_network() and for fewer than one iteration.
  FastBody(const ClothMesh& mesh, const std::vector<forces::LawSpecification>& laws,
           VectorX<double> masses, const FastSettings& settings);

  /// Before the first step: bodies with equal springs that share these are set up once.
  void share(std::shared_ptr<PreparedSolvers> prepared) { prepared_ = std::move(prepared); }
  [[nodiscard]] const FastSettings& settings() const { return settings_; }
  void set_settings(const FastSettings& settings) { settings_ = settings, wake(); }

  /// The body has torn: springs that replace all that have an end among the changed nodes
  /// (flags), masses of all nodes [kg], the last of which are copies of the origins.
  void tear(const fast::SpringNetwork& springs, const std::vector<char>& is_changed,
            VectorX<double> masses, const std::vector<int>& origins);
  /// Another rest length [m], > 0, of the spring between two nodes; does nothing without such a spring.
  void set_rest_length(int first, int second, double rest_length);
  /// Other bending laws, for the masses of the body; they take part in the solution.
  void set_bending(BendingForces bending) { bending_ = std::move(bending); }
  /// A body that sleeps is not to be stepped: only these are called.
  [[nodiscard]] bool is_asleep() const { return sleep_.is_asleep(); }
  [[nodiscard]] bool is_at_rest() const { return sleep_.is_at_rest(settings_); }
  void wake();
  void begin_step(const btSoftBody& body) {
    step_error_ = {};
    if (sleep_.begin_step(body)) last_step_ = 0;
  }
  void meet(const btCollisionObject& object, const btTransform& pose) { sleep_.meet(object, pose); }
  void notify_cloth(bool is_at_rest) { sleep_.notify_cloth(is_at_rest); }
  void end_step(btSoftBody& body, btScalar time_step) {
    sleep_.end_step(body, time_step, settings_);
  }

  /// Forces that others have added to m_f become velocities: impulses, which count once. Before the laws add theirs.
  void apply_external_impulses(btSoftBody& body, btScalar time_step);
  /// btSoftBody::predictMotion. positions and velocities: m_x [m] and m_v [m/s], 3 x n. Touches only the body, but not
  /// its entry in the broadphase: predictions of several bodies may run at the same time.
  void predict(btSoftBody& body, btScalar time_step, const Matrix3X<btScalar>& positions,
               const Matrix3X<btScalar>& velocities);
  /// Instead of btSoftBody::defaultCollisionHandler: notes the object.
  void collide(const btSoftBody& body, const btCollisionObjectWrapper& object, HullTable& hulls,
               btScalar time_step);
  /// Whether predict() was called in this step. A body that is woken up in between is to be left alone.
  [[nodiscard]] bool is_predicted() const { return is_predicted_; }
  /// Appends MovableObject::inertia_owner() of what this body may push in this step, each once.
  void list_coupled(const btSoftBody& body, std::vector<const void*>& list) const;
  /// Whether detect_contacts() and redetect_contacts() touch only the body too.
  [[nodiscard]] bool detects_alone() const;
  /// Whether all stages of this step touch only the body, if no cloth does: no dynamic object is near it or holds it.
  [[nodiscard]] bool is_alone(const btSoftBody& body) const;
  /// After prepare(), once Bullet has moved rigid bodies.
  void detect_contacts(const btSoftBody& body, btScalar time_step);
  /// Into how many substeps the step is to be divided, after detect_contacts() (SubstepCount).
  [[nodiscard]] int num_substeps(const btSoftBody& body, btScalar time_step) const;
  [[nodiscard]] int last_num_substeps() const { return last_num_substeps_; }
  /// How many explicit ones would be stable.
  [[nodiscard]] btScalar num_explicit_substeps(btScalar time_step) const {
    return explicit_.count(time_step);
  }
  [[nodiscard]] const CoupledBodies& pushed() const { return pushed_; }  ///< by the last solution
  /// Appends the dynamic bodies that this one is near to or hangs on, each once.
  void list_dynamic(const btSoftBody& body, std::vector<MovableObject>& list) const;
  /// Around all substeps; each is then a step of its own, from detect_contacts() to end_solve().
  void begin_substeps(const btSoftBody& body, btScalar time_step);
  void begin_substep(btSoftBody& body, const RigidSubsteps& rigid, int substep,
                     const SubstepPlan& plan, btScalar substep_time);
  void end_substeps(btSoftBody& body, btScalar time_step);
  /// Instead of btSoftBody::solveConstraints. prepare(), begin_solve(), solve_again() and end_solve() change only the
  /// body, so that those of several bodies may run at the same time; apply_solution() pushes and moves rigid bodies.
  /// pushed: those of all bodies, in order. Each of several that push one has a share of its inertia: each alone would stop it.
  void prepare(const btSoftBody& body);
  void begin_solve(btSoftBody& body, btScalar time_step, std::span<const void* const> pushed);
  /// Looks for contacts that the solution needs, and bodies that it has pushed into others: is_unfinished() if there are any.
  void redetect_contacts(btSoftBody& body, btScalar time_step);
  [[nodiscard]] bool is_unfinished() const { return is_contact_missing_ || is_support_missing_; }
  /// is_moved: with the impulses that have moved nodes from where write_positions() has put them.
  void solve_again(btSoftBody& body, btScalar time_step, std::span<const void* const> pushed,
                   bool is_moved = false);
  /// In place of prepare() to end_solve() of a body that is alone: ends a step that begins as the last two, at rest (SteadyStep).
  [[nodiscard]] bool repeat_step(btSoftBody& body, btScalar time_step);
  /// A step of the method of ForceHistory with more energy than there was is solved by implicit Euler instead, which cannot.
  void solve_anew_if_it_gains(btSoftBody& body, btScalar time_step);
  /// Writes the solution to m_x, if anybody looks at it before end_solve(). Contacts with cloth are projected then, over all bodies
  /// kClothContactSweeps times, for what one body does to another would be lost otherwise.
  void apply_solution(btSoftBody& body, btScalar time_step, bool is_looked_at);
  void project_cloth_contacts(btSoftBody& body);
  static constexpr int kClothContactSweeps = 16;
  void write_positions(btSoftBody& body);                ///< the solution, to m_x
  void end_solve(btSoftBody& body, btScalar time_step);  ///< velocities, from m_x
  /// The velocities that this step leaves: what differs at the start of the next one has come from outside.
  void note_velocities(const btSoftBody& body);
  /// btSoftBody::updateNormals for a body that keeps normals, once no node moves any more in this step.
  void update_normals(btSoftBody& body);
  [[nodiscard]] bool has_normals() const { return has_normals_; }
  /// [s] The time for which a rate at the end of this step counts: with BDF2 two thirds of the step, the rest is in the steps before.
  [[nodiscard]] btScalar velocity_step() const { return velocity_step_; }
  static constexpr int kMostRedetections = 2;  ///< how often redetect_contacts() is called
  /// With rigid objects, of the last step.
  [[nodiscard]] const std::vector<RigidContact>& contacts() const { return contacts_; }
  /// The largest over the substeps of a step.
  [[nodiscard]] const StepError& step_error() const { return step_error_; }
  void note_unsolved() { step_error_.is_within_tolerance = false; }  ///< contacts were too many

 private:
  friend class FastBodyState;
  enum class Method { kImplicitEuler, kBdf2, kForces, kExplicit };
  /// Kinetic energy of a solution, and the most that what was there and was put in leaves to it [J].
  struct EnergyBalance {
    double kinetic;
    double most;
  };
  void solve(btSoftBody& body, btScalar time_step, const fast::SolverSettings& solver_settings,
             bool is_again);
  [[nodiscard]] bool take_changed_positions(const btSoftBody& body);
  void prepare_solver(const btSoftBody& body);
  [[nodiscard]] fast::ImplicitSolver<btScalar>& active_solver() {
    return method_ == Method::kExplicit ? explicit_.solver() : *solver_;
  }
  void set_free(const std::vector<bool>& is_free);
  [[nodiscard]] bool may_use_history(const btSoftBody& body, btScalar time_step);
  [[nodiscard]] bool may_use_forces(const btSoftBody& body, btScalar time_step);
  [[nodiscard]] Method choose_method(const btSoftBody& body, btScalar time_step);
  void set_targets(const btSoftBody& body, Method method, btScalar time_step);
  void find_velocities();
  void keep_forces(const btSoftBody& body, btScalar time_step);
  [[nodiscard]] bool are_positions_kept();
  void follow_colliders(bool to_solution);
  [[nodiscard]] btTransform solved_pose(const MovableObject& object) const;
  void find_contacts(const btSoftBody& body, const Collider& collider, btScalar time_step,
                     std::vector<RigidContact>& contacts, std::span<const char> is_left_out = {});
  /// Contacts that the solution would need, and that nobody looked for where Bullet had predicted the
  /// nodes. True if there are any.
  [[nodiscard]] bool find_missed_contacts(btSoftBody& body, btScalar time_step);
  void choose_origin(const btSoftBody& body);
  [[nodiscard]] bool was_changed_outside();
  void read_prediction(const btSoftBody& body);
  [[nodiscard]] btVector3 in_world(int node) const;
  void read_constraints(const btSoftBody& body, btScalar time_step, bool is_again);
  void move_pins_evenly();
  /// Whether what cloth does to it in a step comes to pass: what motors make of it is seen in Bullet's next step only.
  [[nodiscard]] bool moves_freely(const MovableObject& object) const {
    return object && !object.is_articulated() && !pinches_.has_finger(object.object());
  }
  /// Whether a node is between two surfaces that press on each other.
  [[nodiscard]] bool is_between(int node) const { return pinches_.has(node) || backed_.has(node); }
  void exchange_impulses(btSoftBody& body, btScalar time_step);
  void project_out_of_missed_colliders(btSoftBody& body, btScalar time_step);
  void project_out_of_planes();
  void project_out_of_colliders(btSoftBody& body) const;
  [[nodiscard]] bool gets_work_from_outside() const;
  [[nodiscard]] EnergyBalance energy_balance(btScalar time_step, double for_bodies);
  void limit_kinetic_energy(btScalar time_step);

  BendingForces bending_;
  fast::SpringNetwork network_;  ///< until solver_ has it
  LimitedStiffness limited_;
  VectorX<double> masses_;
  btScalar wave_speed_;  ///< [m/s]
  ExplicitSubsteps explicit_;
  FastSettings settings_;
  std::unique_ptr<fast::ImplicitSolver<btScalar>> solver_;
  std::shared_ptr<PreparedSolvers> prepared_;  ///< none: this body alone
  std::vector<bool> is_free_;                  ///< that solver_ knows
  std::vector<int> solver_pins_;               ///< likewise
  NetworkHistory history_;
  std::vector<int> pins_;  ///< of the present step
  BodySleep sleep_;
  Vector3<btScalar> origin_ = Vector3<btScalar>::Zero();  ///< that positions are counted from [m]
  // The present step, 3 x n.
  Matrix3X<btScalar> weights_;           ///< masses, each thrice [kg]; 0 for pins
  Matrix3X<btScalar> starts_;            ///< q [m]
  Matrix3X<btScalar> start_velocities_;  ///< v [m/s]
  Matrix3X<btScalar> predicted_;         ///< v + h a [m/s]
  Matrix3X<btScalar> origins_;           ///< what velocities are counted from [m]
  Matrix3X<btScalar> targets_;           ///< y [m]
  Matrix3X<btScalar> positions_;         ///< solution [m]
  Matrix3X<btScalar> velocities_;        ///< solution [m/s]
  // The whole step, while it is divided into substeps.
  Matrix3X<btScalar> whole_starts_;   ///< [m]
  Matrix3X<btScalar> accelerations_;  ///< without springs [m/s^2]
  Matrix3X<btScalar> pin_starts_;     ///< of pins_ in the world, at the end of the step before [m]
  std::vector<btVector3> pin_ends_;   ///< of pins_, at the end [m]
  btScalar time_left_ = 0;            ///< [s] behind the present substep
  // The step before.
  Matrix3X<btScalar> last_starts_;
  Matrix3X<btScalar> last_velocities_;
  btScalar last_spacing_ = 0;           ///< [s] from last_starts_ to starts_
  Matrix3X<btScalar> impulses_;         ///< of the present step, over masses [m/s]; empty: none
  Matrix3X<btScalar> left_velocities_;  ///< at its end, after damping
  ForceHistory force_history_;
  btScalar inertia_step_ = 0;               ///< [s] of the present step
  btScalar velocity_step_ = 0;              ///< [s] likewise: from origins_ to positions_
  int num_substeps_ = 1;                    ///< of the present step
  int last_num_substeps_ = 1;               ///< of the last one
  Method method_ = Method::kImplicitEuler;  ///< of the present step
  btScalar last_step_ = 0;                  ///< [s]; 0: no history
  bool is_explicit_ = false;                ///< the substeps of the present step are
  bool is_predicted_ = false;
  bool has_normals_ = false;   ///< of the positions at the end of the present step
  bool is_written_ = false;    ///< before end_solve()
  bool is_projected_ = false;  ///< out of what the solution let a node into
  StepError step_error_;
  double given_to_bodies_ = 0;       ///< kinetic energy, in the present step [J]
  double excess_ = 0;                ///< energy in springs that projections have put in [J]
  bool is_contact_missing_ = false;  ///< in the present solution, for all that is known
  bool is_support_missing_ = false;  ///< likewise
  std::vector<Collider> colliders_;  ///< of this step
  SteadyStep steady_;
  SweptNodes swept_;
  NodeNormals normals_;
  std::vector<RigidContact> contacts_;
  std::vector<RigidContact> found_;  ///< of a second look
  std::vector<RigidContact> deep_;   ///< of it, with what is immovable, where it is far inside
  KnownContacts known_;
  SettledNodes settled_;
  std::vector<fast::PlaneContact<btScalar>> plane_contacts_;
  std::vector<fast::KinematicNode<btScalar>> kinematic_;
  CoupledBodies pushed_;
  std::vector<fast::NodeSupport<btScalar>> supports_;
  Pinches pinches_;
  BackedNodes backed_;
  StickingPoints sticking_points_;
  LedLinks led_links_;
  std::vector<int> scratch_;  ///< kept for its memory
};

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
