#pragma once

#include <vector>

#include <weft/fast_solver/edge_slots.hpp>
#include <weft/fast_solver/network_kernel.hpp>
#include <weft/fast_solver/node_arrays.hpp>
#include <weft/fast_solver/spring_network.hpp>

namespace weft::fast {

/// The forces of a SpringNetwork and their linearisation, several edges at a time on the vector unit.
///
/// Linearised at x, the stiffness of an edge is s u u^T + t (I - u u^T) with s = k' + c / h along it
/// and t = max(0, f / l) + w across: the part that a compressed spring takes away is left out, so that
/// the matrix stays positive definite (Choi and Ko 2002).
/// Scalar: of places and forces. Products are in single precision, for they only make corrections.
/// Threads  one object from one thread at a time; inside it runs on oneTBB, with the same bits for any
///          number of threads. Allocates nothing after construction.
template <class Scalar>
class NetworkForces {
 public:
  NetworkForces(const SpringNetwork& network, int num_nodes);

  [[nodiscard]] int num_nodes() const { return slots_.num_nodes; }

  /// Lengths at the start of a step of time_step [s], > 0; starts: q, 3 x n [m].
  void begin_step(ConstMatrix3XRef<Scalar> starts, Scalar time_step);

  /// From the next add_forces() on t is at least this share of s, 0 to 1. With 1 no spring can store more than its
  /// linearisation says, so that a step that the linear system thinks good is good (as the global step of Bouaziz et
  /// al. 2014); with 0 steps of Newton's method are as large as they can be.
  void set_least_across(Scalar share) { least_across_ = share; }

  /// forces (3 x n) += those of the network at places x (3 x n) [N], and linearises there.
  void add_forces(ConstMatrix3XRef<Scalar> places, Matrix3XRef<Scalar> forces);

  /// What add_forces() is minus the gradient of [J].
  [[nodiscard]] double potential(ConstMatrix3XRef<Scalar> places);

  /// product = inertia displacements + stiffness displacements [N], with the stiffness of the last
  /// add_forces(). inertia: fill_up(n) [N/m].
  void multiply(const VectorX<float>& inertia, const NodeArrays<float>& displacements,
                NodeArrays<float>& product) const;

  /// The 3 x 3 blocks of the diagonal of that stiffness [N/m].
  [[nodiscard]] const BlockArrays& diagonal_blocks() const { return diagonal_; }

 private:
  [[nodiscard]] NetworkView<Scalar> view() const;
  template <class Run>
  void for_each_task(const Run& run) const;

  EdgeSlots slots_;
  Edges edges_;
  std::vector<Scalar> springs_;
  std::vector<Scalar> damping_;  ///< of each lane [N s/m]; empty: none
  std::vector<Scalar> dampers_;
  std::vector<Scalar> stabilisers_;
  Scalar least_across_ = 0;
  mutable std::vector<float> linear_;
  NodeArrays<Scalar> starts_;
  NodeArrays<Scalar> places_;
  NodeArrays<Scalar> forces_;
  BlockArrays diagonal_;
  std::vector<double> task_sums_;
};

extern template class NetworkForces<float>;
extern template class NetworkForces<double>;

}  // namespace weft::fast
