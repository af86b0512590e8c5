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
#include <weft/fast_solver/newton/direction_weights.hpp>
#include <weft/fast_solver/newton/newton_iteration.hpp>
#include <weft/fast_solver/solver_report.hpp>
#include <weft/fast_solver/solver_settings.hpp>
#include <weft/fast_solver/step_problem.hpp>
#include <weft/fast_solver/threads/node_partition.hpp>
#include <weft/fast_solver/threads/team_loops.hpp>
#include <weft/fast_solver/threads/worker_team.hpp>

namespace weft::fast {

/// Newton's method, each linear system by conjugate gradients, until the energy that is left to gain is below a tolerance. The
/// preconditioner is additive, of two levels (Dryja and Widlund 1987): the blocks of the diagonal, which are exact where
/// neighbors have little to say, and a correction on coarse basis functions over aggregates of nodes, which have the stiffness of the present
/// step: what the cloth does slowly and together. Contacts are eliminated: a node on a plane moves in
/// the plane, one that sticks not at all (Baraff and Witkin 1998), and what it takes to hold them is
/// the contact force, whose sign and friction decide how the next iteration holds them. Nodes that touch a rigid body
/// which is coupled both ways, or hang on it, move with it: its six unknowns are solved for with the nodes.
///
/// Places and forces in Scalar, corrections in single precision.
/// Deterministic: the same bits for any number of threads. No allocation in solve(), except for more
/// contacts than ever before, and where other nodes are led than in the step before.
template <class Scalar>
class ImplicitSolver : TeamLoops {
 public:
  using Vector6 = Eigen::Matrix<Scalar, 6, 1>;

  /// masses: n [kg], > 0; is_free: n. Throws InvalidArgument for sizes that do not fit.
  ImplicitSolver(const SpringNetwork& network, const VectorX<double>& masses,
                 const std::vector<bool>& is_free);

  [[nodiscard]] int num_nodes() const { return forces_.num_nodes(); }

  /// The cloth has come apart: springs in the place of all that have an end among the changed nodes (flags),
  /// copies of the origins behind the other nodes, masses of all [kg]. Takes a small part of what a
  /// solver made anew takes, because coarse basis functions stay: copies have their origins' parts in them.
  void tear(const SpringNetwork& springs, const std::vector<char>& is_changed,
            const VectorX<double>& masses, const std::vector<int>& origins);

  /// Other nodes are free than before: n flags. Takes time for what is near them only.
  void set_free(const std::vector<bool>& is_free);

  /// positions: 3 x n [m], in: a guess; out: the solution.
  void solve(const StepProblem<Scalar>& problem, const SolverSettings& solver_settings,
             Matrix3XRef<Scalar> positions) {
    WorkerTeam serial;
    solve(problem, solver_settings, positions, serial);
  }
  void solve(const StepProblem<Scalar>& problem, const SolverSettings& solver_settings,
             Matrix3XRef<Scalar> positions, WorkerTeam& team);

  /// After solve(): what a node is pushed with by contacts, or a kinematic node by what leads it [N]; zero for others.
  [[nodiscard]] Vector3<Scalar> constraint_force(int node) const {
    return at_node(constraint_forces_, node);
  }
  /// After solve(): ways of some nodes in a row, 3 x their number [m] += what positions would need to be on top, if they had more digits; at most the
  /// rounding of each. Of a slow motion in short steps it is a good part.
  void add_compensation(int first_node, Matrix3XRef<Scalar> displacements) const;
  /// After solve(): forces of springs and of the step's own forces on some nodes in a row, 3 x their number [N].
  void get_forces(int first_node, Matrix3XRef<Scalar> forces) const;
  /// After solve(): the contact of the problem that holds a node, or -1.
  [[nodiscard]] int contact_of(int node) const {
    return contact_of_[static_cast<std::size_t>(node)];
  }
  /// After solve(): how far a body of the problem is coupled both ways, of its center [m] and about it [rad]: the nodes have pushed
  /// it and what holds it with (inertia + held) motion / h^2.
  [[nodiscard]] Vector6 body_motion(int body) const {
    return bodies_[static_cast<std::size_t>(body)].motion;
  }
  /// After solve(): m |y - q|^2 / (2 h'^2), the energy of the motion without springs [J].
  [[nodiscard]] double step_energy() const { return step_energy_; }
  /// What springs store at positions, and what dampers take away on the way there from the start of the step [J].
  [[nodiscard]] double spring_energy(ConstMatrix3XRef<Scalar> positions, WorkerTeam& team);
  /// After solve(): whether a node was put in front of a plane that the last linear system did not know.
  [[nodiscard]] bool was_clamped() const { return was_clamped_; }
  /// After solve().
  [[nodiscard]] const SolverReport& report() const { return report_; }
  /// After solve(): root mean square of the residual forces over that of the step's first guess [-].
  [[nodiscard]] double residual() const { return residual_; }

 private:
  using Floats = NodeArrays<float>;
  using Nodes = NodeArrays<Scalar>;
  using Floats6 = Eigen::Matrix<float, 6, 1>;
  using Matrix6 = Eigen::Matrix<float, 6, 6>;
  using Link = BodyLink;
  using Body = LinkedBody<Scalar>;

  /// [m] of the last linear system.
  [[nodiscard]] Vector3<Scalar> step_of(Eigen::Index node) const {
    return step_.row(node).transpose().template cast<Scalar>();
  }
  void set_nodes(const VectorX<double>& masses, const std::vector<bool>& is_free);
  void list_pinned();
  void change_correction(const std::vector<int>& changed);
  [[nodiscard]] std::vector<bool> have_basis_weights(const std::vector<int>& nodes) const;
  void follow_kinematic(const StepProblem<Scalar>& problem);
  void load(const StepProblem<Scalar>& problem, ConstMatrix3XRef<Scalar> guess);
  void evaluate(bool linearizes = true);
  void evaluate_step_forces();
  [[nodiscard]] double energy_of_step_forces(const Nodes& positions);
  void decide_contact_states(const StepProblem<Scalar>& problem, const NewtonIteration& iteration);
  void set_friction(const PlaneContact<Scalar>& contact, Scalar expected);
  [[nodiscard]] Scalar slip_of(const PlaneContact<Scalar>& contact,
                               const Vector3<Scalar>& position) const;
  [[nodiscard]] Scalar largest_stiffness(int node) const;
  void update_friction(const StepProblem<Scalar>& problem);
  void set_system_inertia();
  void decide_contact_state(const PlaneContact<Scalar>& contact, const NewtonIteration& iteration);
  void list_constrained();
  [[nodiscard]] Scalar rounding_of_force(int node) const;
  [[nodiscard]] Scalar first_push(int node, const Vector3<Scalar>& normal) const;
  void project(NodeRange nodes, Floats& vectors) const;
  void smooth(NodeRange nodes, Floats& correction);
  void smooth(int part);
  void load_bodies(const StepProblem<Scalar>& problem);
  void link(int node, int body, const Vector3<Scalar>& lever_arm, const Vector3<Scalar>& normal);
  /// The motion of what is at the end of an arm, to first order.
  [[nodiscard]] static Vector3<Scalar> motion_at(const Vector6& motion,
                                                 const Vector3<Scalar>& lever_arm) {
    return motion.template head<3>() + motion.template tail<3>().cross(lever_arm);
  }
  [[nodiscard]] Vector3<Scalar> motion_with(int body, const Vector3<Scalar>& lever_arm) const;
  [[nodiscard]] Vector3<Scalar> turned(int body, const Vector3<Scalar>& lever_arm) const;
  [[nodiscard]] Vector3<Scalar> position_of(const KinematicNode<Scalar>& kinematic) const;
  /// Adds each linked node's part of a motion of its body to its row.
  void add_motions(Floats6 Body::*motion, Floats& displacements) const;
  /// Adds the rows of linked nodes to the forces on their bodies: the transpose.
  void gather(const Floats& forces, Floats6 Body::*sum);
  void gather_of(int body, const Floats& forces, Floats6& sum) const;
  void release_bodies();
  void factorize_bodies();
  void find_body_residuals(Floats6 Body::*result);
  [[nodiscard]] double work_of_bodies();
  /// product = P (inertia + stiffness) displacements, and what follows from it for bodies; then and_then(nodes, part).
  template <class Next>
  void multiply(const Floats& displacements, Floats6 Body::*motion, Floats& product,
                Floats6 Body::*body_product, const Next& and_then);
  void start_linear(const StepProblem<Scalar>& problem);
  [[nodiscard]] LinearGain solve_linear(const StepProblem<Scalar>& problem, int iterations,
                                        double least_gain);
  /// The products of a correction c and the direction d before it: c . r, c . A d and c . A c.
  using Overlaps = VectorKernel::Products;
  [[nodiscard]] Overlaps precondition(Floats& correction, bool is_first);
  void sum_up(NodeRange nodes, bool keeps_direction);
  void move();
  void iterate_once(const StepProblem<Scalar>& problem, const NewtonIteration& iteration);
  void iterate(const StepProblem<Scalar>& problem, const SolverSettings& solver_settings);
  [[nodiscard]] double gain_of_rounding();
  void save_positions();
  void restore_positions();
  [[nodiscard]] double accelerate(const StepProblem<Scalar>& problem, double reached);
  /// What an implicit step minimizes [J].
  [[nodiscard]] double energy(const StepProblem<Scalar>& problem, const Nodes& positions,
                              Vector6 Body::*motion);
  [[nodiscard]] double energy_of(NodeRange nodes, const Nodes& positions) const;
  [[nodiscard]] double energy_of_contacts(const StepProblem<Scalar>& problem,
                                          const Nodes& positions, Vector6 Body::*motion) const;
  void stay_at_start(const StepProblem<Scalar>& problem);
  void enforce_descent(const StepProblem<Scalar>& problem, int iterations);
  void restore_start();
  /// Only part of the last step, if it went too far; evaluate() is due then. num_constrained: of the linear system, not of clamp().
  bool shorten_step(double work_before, std::size_t num_constrained);
  void move_bodies(Scalar share);
  /// The work of the residual forces with the step, at nodes with a hold [J].
  [[nodiscard]] double work_of_constrained(std::size_t num_constrained) const;
  void find_constraint_forces();
  [[nodiscard]] double residual_norm();
  /// A shift of all nodes [m]; bodies are shifted already.
  [[nodiscard]] std::optional<Vector3<Scalar>> net_momentum_correction(
      const StepProblem<Scalar>& problem);
  void update_compensation(NodeRange nodes);
  void clamp(const StepProblem<Scalar>& problem);

  const StepForces<Scalar>* step_force_law_ = nullptr;  ///< likewise
  NetworkForces<Scalar> forces_;
  CoarseCorrection coarse_correction_;
  VectorX<Scalar> masses_;  ///< [kg], filled up with zeros
  std::vector<bool> is_free_;
  std::vector<int> pinned_;
  std::vector<int> kinematic_;  ///< ascending: of the last step
  std::vector<int> next_kinematic_;
  std::vector<int> constrained_;  ///< nodes with a hold, in order while linear systems are solved
  std::vector<Link> links_;
  std::vector<Body> bodies_;
  std::vector<int> linked_blocks_;   ///< of nodes
  VectorX<float> inertia_;           ///< m / h'^2 [N/m]; 0 for pinned nodes; filled up with zeros
  VectorX<float> system_inertia_;    ///< the same with the drag of friction
  bool has_drag_ = false;            ///< system_inertia_ differs
  VectorX<Scalar> drag_;             ///< of each sliding node [N/m]
  VectorX<Scalar> friction_bounds_;  ///< likewise, by Coulomb's law [N]
  VectorX<Scalar> weights_;          ///< the same in Scalar
  // The present problem [m].
  Nodes inertial_positions_;
  Nodes start_positions_;
  Nodes positions_;
  Nodes residual_forces_;  ///< residual forces [N]
  Nodes constraint_forces_;
  Nodes compensation_;
  Nodes unmoved_;
  Nodes last_positions_;  ///< where the iteration began
  Nodes last_results_;    ///< of the iteration before
  AndersonHistory<Scalar> anderson_;
  Matrix3X<Scalar> step_force_positions_;  ///< as StepForces take them
  Matrix3X<Scalar> step_forces_;
  std::vector<ContactState> contact_states_;         ///< of each node, filled up
  std::vector<ContactState> contact_states_before_;  ///< the same in the iteration before
  std::vector<int> contact_of_;  ///< of each node: the contact that holds it, or -1
  Matrix3X<float> normals_;      ///< of each node on a plane
  Matrix3X<float> friction_;     ///< of each sliding node [N]
  BlockArrays blocks_;           ///< inverse of the diagonal's
  Floats step_, residual_vector_, direction_, direction_product_, correction_product_, work_;
  Floats smoothed_, coarse_;  ///< parts of a correction
  std::array<Floats, DirectionWeights::kMost> corrections_;
  alignas(kAlignment) DirectionWeights directions_;  ///< made of them; not near what workers read
  bool has_direction_ = false;   ///< from before the first of them, in direction_
  double work_left_ = 0;         ///< residual_forces_ . step_ [J]
  double residual_squares_ = 0;  ///< of residual_forces_ [N^2]
  double work_done_ = 0;         ///< the same before the step was taken [J]
  double residual_ = 0;
  LinearGain last_gain_;  ///< of the last iteration
  SolverReport report_;
  double step_energy_ = 0;
  bool has_constraint_forces_ = false;
  bool was_clamped_ = false;
  bool have_contact_states_changed_ = false;  ///< in the last iteration
};

extern template class ImplicitSolver<float>;
extern template class ImplicitSolver<double>;

}  // namespace weft::fast
