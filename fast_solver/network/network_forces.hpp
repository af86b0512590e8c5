#pragma once

// Tested by tests/fast_solver/network/spring_network_test.cpp, tests/fast_solver/network/edge_slots_test.cpp.

#include <cstdint>
#include <vector>

#include <weft/fast_solver/coarse/coarse_correction.hpp>
#include <weft/fast_solver/network/connectivity_graph.hpp>
#include <weft/fast_solver/network/edge_slots.hpp>
#include <weft/fast_solver/network/network_kernel.hpp>
#include <weft/fast_solver/network/node_arrays.hpp>
#include <weft/fast_solver/network/spring_network.hpp>
#include <weft/fast_solver/shared_value.hpp>

namespace weft::fast {

/// The forces of a SpringNetwork and their linearization, several edges at a time on the vector unit.
///
/// The stiffness of an edge at x is s u u^T + t (I - u u^T), with s = k' + c / h axial and t = max(0, f / l) + w transverse. The
/// negative transverse stiffness of a compressed spring is left out, so that the matrix stays positive definite (Choi and Ko
/// 2002). Positions and forces are Scalar. Products are single precision, which suffices because they only make corrections.
/// Threads  functions that take node ranges may run for several ranges at once; all others from one thread at a time. Only the
///          constructor, replace() and the functions that describe the network allocate memory.
template <class Scalar>
class NetworkForces {
 public:
  NetworkForces(const SpringNetwork& network, int num_nodes);

  [[nodiscard]] int num_nodes() const { return slots_->num_nodes; }

  /// Puts springs in the place of all that have an end among the nodes that are changed (flags of num_nodes nodes; there may be
  /// more than before, all new ones changed). springs: each has such an end; without bending, those with one only are as they were.
  /// Takes time for what changes only: blocks that grow are laid out anew behind the others. Results are those of a network made
  /// anew, but for the order in which the springs of some nodes are summed. Returns flags of the blocks that were laid out anew.
  std::vector<char> replace(const SpringNetwork& springs, const std::vector<char>& is_changed,
                            int num_nodes);
  /// Another rest length [m], > 0, of the spring between two nodes, from the next add_forces() on. Nothing without such a spring.
  void set_rest_length(int first, int second, double rest_length);
  /// Share of the slots that no block uses any more [-].
  [[nodiscard]] double unused_share() const;

  [[nodiscard]] NodeRange all_nodes() const { return {0, padded_size(num_nodes())}; }

  /// To be called before begin_step() of each part: the time step of dampers [s], > 0.
  void set_time_step(Scalar time_step);
  /// Notes what the rest of the step needs of its start; starts: q of all nodes [m].
  void begin_step(NodeRange nodes, const NodeArrays<Scalar>& starts);

  /// From the next add_forces() on, t is at least this share of s, 0 to 1. With 1 the linearization bounds every spring's energy
  /// from above, so that a step which decreases the model decreases the energy (as the global step of Bouaziz et al. 2014). With
  /// 0 the model is closest to the springs and Newton's steps are largest.
  void set_least_transverse_stiffness(Scalar share) { least_transverse_ = share; }

  /// forces += those of the network at positions x of all nodes [N], and linearizes there unless told not to.
  void add_forces(NodeRange nodes, const NodeArrays<Scalar>& positions, NodeArrays<Scalar>& forces,
                  bool linearizes = true);

  /// What add_forces() is minus the gradient of, the nodes' part [J].
  [[nodiscard]] double potential(NodeRange nodes, const NodeArrays<Scalar>& positions) const;

  /// product = inertia displacements + stiffness displacements [N], with the stiffness of the last
  /// linearization. inertia: rows_for(n) [N/m].
  void multiply(NodeRange nodes, const VectorX<float>& inertia,
                const NodeArrays<float>& displacements, NodeArrays<float>& product) const;

  /// The 3 x 3 blocks of the diagonal of that stiffness [N/m].
  [[nodiscard]] const BlockArrays& diagonal_blocks() const { return diagonal_; }
  [[nodiscard]] BlockArrays& diagonal_blocks() { return diagonal_; }
  /// From the next linearization on, whether its stiffness is without that of bending; the coarse correction's is with it.
  void leave_out_bending(bool is_out) { is_bending_out_ = is_out; }

  [[nodiscard]] const EdgeSlots& slots() const { return *slots_; }
  /// The springs between some nodes; what couples them to others is in the diagonal only. Dampers count as in steps of 1/60 s.
  [[nodiscard]] ConnectivityGraph connectivity_graph(const std::vector<int>& names) const;
  /// Neighborhood 0 to num_springs around some nodes.
  [[nodiscard]] Neighborhood neighborhood_of(const std::vector<int>& nodes, int num_springs) const;
  /// Tells a correction of the stiffness of bending; to be called whenever its basis or the network has changed.
  void note_bending(CoarseCorrection& correction) const;
  /// Makes a correction for the last linearization.
  void factorize(CoarseCorrection& correction, std::span<const char> is_held,
                 std::span<const SlidingNode> sliding, float inertia_over_mass,
                 WorkerTeam& team) const {
    correction.factorize(linear_.data(), root_scale_, is_held, sliding, inertia_over_mass, team);
  }

 private:
  /// A spring as one of its ends sees it.
  struct Spring {
    std::uint64_t place;  ///< in the order of a network's edges
    EdgeLane lane;
    Scalar rest_length;
    Scalar stiffness;
    Scalar compressed;  ///< what compression adds to the stiffness
    Scalar damping;
    float bending;
  };
  [[nodiscard]] NetworkView<Scalar> view() const;
  void note_stiffest(const SpringNetwork& springs);
  void choose_scale(double time_step);
  void reserve(std::size_t num_slots);
  void resize_arrays();
  [[nodiscard]] std::vector<char> blocks_to_change(const SpringNetwork& springs,
                                                   const std::vector<char>& is_changed) const;
  void keep_springs(int block, const std::vector<char>& is_changed,
                    std::vector<Spring>& result) const;
  void lay_out(int block, std::vector<Spring>& springs);
  void write(std::size_t place, const Spring& spring);

  SharedValue<EdgeSlots> slots_;
  std::vector<int> room_;  ///< for each block: slots from its first one on
  SlotMaker maker_;
  SharedValue<AlignedVector<Scalar>> springs_;
  bool has_damping_ = false;  ///< without: no array
  bool has_bending_ = false;
  bool is_bending_out_ = false;
  AlignedVector<Scalar> damping_;  ///< for each lane [N s/m]
  AlignedVector<Scalar> dampers_;
  AlignedVector<float> bending_;
  Scalar least_transverse_ = 0;
  double stiffest_ = 0;     ///< [N/m]
  double most_damped_ = 0;  ///< [N s/m]
  mutable AlignedVector<std::uint16_t> linear_;
  float root_scale_ = 1;
  Scalar time_step_ = 1;  ///< [s]
  BlockArrays diagonal_;
};

extern template class NetworkForces<float>;
extern template class NetworkForces<double>;

}  // namespace weft::fast
