#pragma once

#include <array>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include <weft/fast_solver/coarse/coarse_correction.hpp>
#include <weft/fast_solver/linked_body.hpp>
#include <weft/fast_solver/network/network_forces.hpp>
#include <weft/fast_solver/network/node_arrays.hpp>
#include <weft/fast_solver/network/spring_network.hpp>
#include <weft/fast_solver/newton/anderson_history.hpp>
#include <weft/fast_solver/newton/body_couplings.hpp>
#include <weft/fast_solver/newton/body_links.hpp>
#include <weft/fast_solver/newton/coarse_roles.hpp>
#include <weft/fast_solver/newton/direction_weights.hpp>
#include <weft/fast_solver/newton/newton_iteration.hpp>
#include <weft/fast_solver/newton/node_supports.hpp>
#include <weft/fast_solver/newton/present_step_forces.hpp>
#include <weft/fast_solver/newton/sliding_friction.hpp>
#include <weft/fast_solver/solver_report.hpp>
#include <weft/fast_solver/solver_settings.hpp>
#include <weft/fast_solver/step_problem.hpp>
#include <weft/fast_solver/threads/node_partition.hpp>
#include <weft/fast_solver/threads/team_loops.hpp>
#include <weft/fast_solver/threads/worker_team.hpp>

namespace weft::fast {

/// Minimizes the incremental potential of one implicit step by Newton's method with a line search (Baraff and Witkin 1998; Gast
/// et al. 2015). docs/implicit_step.md describes the whole iteration.
/// Flexible conjugate gradients (Notay 2000) solve each linear system. The preconditioner is the sum of two levels (Dryja and
/// Widlund 1987) and of a 6 x 6 block for each rigid body. The fine level inverts the 3 x 3 diagonal blocks. The coarse level is smoothed aggregation with the
/// stiffness of the present step, because diagonal blocks do not see slow motions of the whole cloth.
///
/// Contacts are eliminated from the linear system (Baraff and Witkin 1998): a sliding node moves in its plane and a sticking
/// node not at all. The residual at such a node is the contact force. Its sign and Coulomb's law decide contact states, in the
/// first iterations and then at solutions. Nodes that touch a two-way coupled rigid body move with it, and its six unknowns are solved for together
/// with the nodes.
///
/// Positions and forces are Scalar; corrections are single precision. Results have the same bits for any number of threads.
/// solve() allocates memory only if there are more contacts than ever before or if the set of kinematic nodes has changed.
template <class Scalar>
class ImplicitSolver : TeamLoops {
 public:
  using Vector6 = Eigen::Matrix<Scalar, 6, 1>;

  /// masses: n [kg], > 0; is_free: n. Throws InvalidArgument for sizes that do not fit.
  ImplicitSolver(const SpringNetwork& network, const VectorX<double>& masses,
                 const std::vector<bool>& is_free);

  [[nodiscard]] int num_nodes() const { return forces_.num_nodes(); }

  /// Updates the solver after the cloth has torn. springs: replaces all springs with an end among the changed nodes (flags);
  /// masses: those of all nodes [kg]; origins: nodes whose copies are appended behind the others. It is much faster than a
  /// new solver because a copy keeps the coarse basis functions of its origin.
  void tear(const SpringNetwork& springs, const std::vector<char>& is_changed,
            const VectorX<double>& masses, const std::vector<int>& origins);

  /// Another rest length l0 [m], > 0, of the spring between nodes i and j. Does nothing without such a spring.
  void set_rest_length(int i, int j, double l0) { forces_.set_rest_length(i, j, l0); }
  /// Changes which nodes are free: n flags. The cost depends only on the neighborhood of the nodes that have changed.
  void set_free(const std::vector<bool>& is_free);

  /// Solves one step. positions: 3 x n [m]; on entry the initial guess, on return the solution.
  void solve(const StepProblem<Scalar>& problem, const SolverSettings& solver_settings,
             Matrix3XRef<Scalar> positions) {
    WorkerTeam serial;
    solve(problem, solver_settings, positions, serial);
  }
  void solve(const StepProblem<Scalar>& problem, const SolverSettings& solver_settings,
             Matrix3XRef<Scalar> positions, WorkerTeam& team);

  /// After solve(): the force of a contact on its node, or the force that moves a kinematic node [N]. It is zero for other nodes.
  [[nodiscard]] Vector3<Scalar> constraint_force(int node) const {
    return at_node(constraint_forces_, node);
  }
  /// After solve(): adds the compensated update to displacements of consecutive nodes, 3 x their number [m]. Rounding removed
  /// it from the positions. It matters because a slow motion moves nodes by few units in the last place in a short step.
  void add_compensation(int first_node, Matrix3XRef<Scalar> displacements) const;
  /// After solve(): the forces of the springs and of StepForces on some consecutive nodes, 3 x their number [N].
  void get_forces(int first_node, Matrix3XRef<Scalar> forces) const;
  /// After solve(): the index of the problem's contact that is active at a node, or -1, and its state.
  [[nodiscard]] std::pair<int, ContactState> contact_of(std::size_t node) const {
    return {contact_of_[node], contact_states_[node]};
  }
  /// After solve(): whether a node in contact does not slip: it sticks, or slides so little that friction has not its bound.
  [[nodiscard]] bool is_held_by_friction(int node) const {
    const ContactState state = contact_states_[static_cast<std::size_t>(node)];
    return state == ContactState::kFixed ||
           (state == ContactState::kOnPlane && friction_.holds(node));
  }
  /// After solve(): the force of one of the problem's supports on its node [N].
  [[nodiscard]] Vector3<Scalar> support_force(std::size_t support) const {
    return supports_.force_of(support, positions_, start_positions_, bodies_);
  }
  /// After solve(): the generalized displacement of a two-way coupled body relative to its motion without the cloth: translation of
  /// its center [m] and rotation about it [rad]. The force on the body is (inertia + held) motion / h'^2, for h'^2 / h.
  [[nodiscard]] Vector6 body_motion(int body) const {
    return bodies_[static_cast<std::size_t>(body)].motion;
  }
  /// After solve(): m |y - q|^2 / (2 h'^2), the energy of the step's motion without springs [J].
  [[nodiscard]] double step_energy() const { return step_energy_; }
  /// The energy that springs store at these positions plus what dampers dissipate on the way there from the start of the step [J].
  [[nodiscard]] double spring_energy(ConstMatrix3XRef<Scalar> positions, WorkerTeam& team);
  /// forces += those of the network without dampers at these positions [N]; both 3 x n.
  void find_spring_forces(ConstMatrix3XRef<Scalar> positions, Matrix3XRef<Scalar> forces,
                          WorkerTeam& team);
  /// The next solve() goes on with the contact states that another solver of the same nodes has ended with.
  void continue_contacts(const ImplicitSolver& other);
  /// After solve(): whether a node was projected onto a plane that was not part of the last linear system.
  [[nodiscard]] bool was_clamped() const { return was_clamped_; }
  /// After solve().
  [[nodiscard]] const SolverReport& report() const { return report_; }
  /// After solve(): the root mean square residual over that of the initial guess [-].
  [[nodiscard]] double residual() const { return residual_; }

 private:
  friend struct SolverState;
  using Floats = NodeArrays<float>;
  using Nodes = NodeArrays<Scalar>;
  using Floats6 = Eigen::Matrix<float, 6, 1>;
  using Body = LinkedBody<Scalar>;

  /// [m] of the last linear system.
  [[nodiscard]] Vector3<Scalar> step_of(Eigen::Index node) const {
    return step_.row(node).transpose().template cast<Scalar>();
  }
  void set_nodes(const VectorX<double>& masses, const std::vector<bool>& is_free);
  void list_pinned();
  void change_correction(const std::vector<int>& changed);
  [[nodiscard]] std::vector<int> nodes_without_weights() const;
  [[nodiscard]] std::vector<bool> have_basis_weights(const std::vector<int>& nodes) const;
  void follow_kinematic(const StepProblem<Scalar>& problem);
  void load(const StepProblem<Scalar>& problem, ConstMatrix3XRef<Scalar> guess);
  void evaluate(bool linearizes = true);
  void find_strains(const Floats& displacements);
  void multiply_nodes(NodeRange nodes, const Floats& displacements, Floats& product) const {
    forces_.multiply(nodes, system_inertia_, displacements, product);
    step_forces_.add_products(nodes, product);
  }
  void decide_contact_states(const StepProblem<Scalar>& problem, const NewtonIteration& iteration);
  /// There friction is a constant force: with a drag, which can stop a node, towels that ought to slip were held between fingers,
  /// whose motors take back what the solution gives to links.
  [[nodiscard]] bool is_on_link(const PlaneContact<Scalar>& contact) const {
    return contact.body >= 0 && bodies_[static_cast<std::size_t>(contact.body)].is_link;
  }
  void relieve(NodeRange nodes, const Floats& displacements, Floats& product) const;
  [[nodiscard]] Scalar resistance_of(int node) const;
  [[nodiscard]] Vector3<Scalar> slip_of(const PlaneContact<Scalar>& contact,
                                        const Vector3<Scalar>& position,
                                        Vector6 Body::*motion) const;
  [[nodiscard]] Scalar largest_stiffness(int node) const;
  void update_friction(const StepProblem<Scalar>& problem, bool is_cautious);
  void update_supports(const StepProblem<Scalar>& problem, const NewtonIteration& iteration);
  void set_system_inertia();
  void decide_contact_state(const PlaneContact<Scalar>& contact, const NewtonIteration& iteration);
  void list_constrained();
  void find_coarse_roles();
  [[nodiscard]] Scalar rounding_of_force(int node) const;
  [[nodiscard]] Scalar rounding_of_position(int node) const;
  [[nodiscard]] Scalar first_push(int node, const Vector3<Scalar>& normal) const;
  void project(NodeRange nodes, Floats& vectors) const;
  void smooth(int part);
  void load_bodies(const StepProblem<Scalar>& problem);
  void link(int node, int body, const Vector3<Scalar>& lever_arm, const Vector3<Scalar>& normal);
  /// The displacement at the end of a lever arm, to first order.
  [[nodiscard]] static Vector3<Scalar> motion_at(const Vector6& motion,
                                                 const Vector3<Scalar>& lever_arm) {
    return motion.template head<3>() + motion.template tail<3>().cross(lever_arm);
  }
  [[nodiscard]] Vector3<Scalar> motion_with(int body, const Vector3<Scalar>& lever_arm) const;
  [[nodiscard]] Vector3<Scalar> turned(int body, const Vector3<Scalar>& lever_arm) const;
  [[nodiscard]] Vector3<Scalar> position_of(const KinematicNode<Scalar>& kinematic) const;
  void release_bodies();
  void factorize_bodies();
  void find_body_residuals(Floats6 Body::*result);
  [[nodiscard]] double work_of_bodies();
  /// product = P (inertia + stiffness) displacements, and what follows from it for bodies; then and_then(nodes, part).
  template <class Next>
  void multiply(const Floats& displacements, Floats6 Body::*motion, Floats& product,
                Floats6 Body::*body_product, const Next& and_then);
  void start_linear(const StepProblem<Scalar>& problem);
  [[nodiscard]] LinearGain solve_linear(const StepProblem<Scalar>&, const NewtonIteration&);
  /// The products of a correction c and the direction d before it: c . r, c . A d and c . A c.
  using Overlaps = VectorKernel::Products;
  [[nodiscard]] Overlaps precondition(Floats& correction, bool is_first);
  void sum_up(NodeRange nodes, bool keeps_direction);
  void move();
  void iterate_once(const StepProblem<Scalar>& problem, const NewtonIteration& iteration);
  void iterate(const StepProblem<Scalar>& problem, const SolverSettings& solver_settings);
  [[nodiscard]] double motion_that_counts(bool has_contacts);
  [[nodiscard]] double gain_of_rounding_now(bool is_on_fixed);
  void save_positions();
  void restore_positions();
  [[nodiscard]] double shorten_bending(const StepProblem<Scalar>& problem, double now, double most);
  [[nodiscard]] double accelerate(const StepProblem<Scalar>& problem, double reached);
  /// The incremental potential [J].
  [[nodiscard]] double energy(const StepProblem<Scalar>& problem, const Nodes& positions,
                              Vector6 Body::*motion);
  [[nodiscard]] double energy_of(NodeRange nodes, const Nodes& positions) const;
  [[nodiscard]] double energy_of_contacts(const StepProblem<Scalar>& problem,
                                          const Nodes& positions, Vector6 Body::*motion) const;
  void stay_at_start(const StepProblem<Scalar>& problem);
  void enforce_descent(const StepProblem<Scalar>& problem, int iterations);
  void restore_start();
  /// Shortens or lengthens the last step by how much of work_before, the work of all forces with it [J], is left at its end. Returns
  /// whether evaluate() is due.
  bool line_search(const StepProblem<Scalar>& problem, const NewtonIteration& iteration,
                   double work_before);
  void move_bodies(Scalar share);
  /// The work with the step that constraints take up [J]: that of the residual forces at constrained nodes. Where there is no dynamic
  /// body, nodes that slide keep what acts along their planes, with the friction at these positions.
  [[nodiscard]] double work_of_constraints(const StepProblem<Scalar>& problem,
                                           const Nodes& positions) const;
  void find_constraint_forces();
  [[nodiscard]] double residual_norm();
  /// A shift of all nodes [m]; bodies are shifted already.
  [[nodiscard]] std::optional<Vector3<Scalar>> net_momentum_correction(
      const StepProblem<Scalar>& problem);
  void clamp(const StepProblem<Scalar>& problem);
  void put_in_front(const StepProblem<Scalar>& problem);

  PresentStepForces<Scalar> step_forces_;
  NetworkForces<Scalar> forces_;
  CoarseCorrection coarse_correction_;
  VectorX<Scalar> masses_;  ///< [kg], padded with zeros
  std::vector<bool> is_free_;
  std::vector<int> pinned_;
  bool has_torn_ = false;
  std::vector<int> kinematic_;  ///< those of the last step, ascending
  std::vector<int> next_kinematic_;
  std::vector<int> constrained_;  ///< not kFree; ascending while linear systems are solved
  CoarseRoles coarse_roles_;
  std::vector<BodyLink> links_;
  std::vector<Body> bodies_;
  BodyCouplings<Scalar> couplings_;
  NodeSupports<Scalar> supports_;
  std::vector<int> linked_blocks_;  ///< blocks of nodes that are linked to one body
  VectorX<float> inertia_;          ///< m / h'^2 [N/m]; 0 for pinned nodes; padded with zeros
  VectorX<float> system_inertia_;   ///< inertia_ plus the drag of friction
  bool has_drag_ = false;           ///< system_inertia_ differs
  SlidingFriction<Scalar> friction_;
  VectorX<Scalar> weights_;  ///< inertia_ in Scalar
  // The present problem [m].
  Nodes inertial_positions_, start_positions_, positions_;
  Nodes residual_forces_;  ///< residual forces [N]
  Nodes constraint_forces_;
  Nodes compensation_, unmoved_;
  Nodes last_positions_;  ///< positions at the start of the iteration
  Nodes last_results_;    ///< result of the last iteration
  AndersonHistory<Scalar> anderson_;
  std::vector<ContactState> contact_states_;         ///< for each node, padded
  std::vector<char> has_slid_;                       ///< flags of nodes: in this step
  std::vector<ContactState> contact_states_before_;  ///< contact states of the iteration before
  std::vector<int> contact_of_;                      ///< for each node: its active contact, or -1
  Matrix3X<float> normals_;                          ///< for each node on a plane
  BlockArrays blocks_;                               ///< inverse diagonal blocks
  Floats step_, residual_vector_, direction_, direction_product_, correction_product_, work_;
  Floats smoothed_, coarse_;  ///< parts of a correction
  std::array<Floats, DirectionWeights::kMost> corrections_;
  alignas(kAlignment) DirectionWeights directions_;  ///< of corrections_; workers read others
  bool has_direction_ = false;   ///< direction_ holds the one before corrections_[0]
  double work_left_ = 0;         ///< residual_forces_ . step_ [J]
  double residual_squares_ = 0;  ///< squared norm of residual_forces_ [N^2]
  double energy_before_ = 0;     ///< the incremental potential before an iteration [J]
  double work_done_ = 0;         ///< work_left_ before the step was taken [J]
  LinearGain last_gain_;         ///< gain of the last iteration
  LinearGains gains_;            ///< of the last linear solve
  SolverReport report_;
  double residual_ = 0, step_energy_ = 0;
  bool has_constraint_forces_ = false, was_clamped_ = false, was_lengthened_ = false,
       has_met_planes_ = false;
  bool have_contact_states_changed_ = false;  ///< in the last iteration
};

extern template class ImplicitSolver<float>;
extern template class ImplicitSolver<double>;

}  // namespace weft::fast
