#pragma once

#include <cstdint>
#include <vector>

#include <weft/custom_forces/edge_assembly.hpp>
#include <weft/fast_solver/spring_network.hpp>

namespace weft::fast {

/// The forces of a SpringNetwork and their linearisation, edge by edge on the vector unit.
///
/// Linearised at x, the stiffness of an edge is s u u^T + t (I - u u^T) with s = k' + c / h along it
/// and t = max(0, f / l) + w across: the part that a compressed spring takes away is left out, so that
/// the matrix stays positive definite (Choi and Ko 2002).
/// Scalar: of places and forces. Products are in single precision, for they only make corrections.
template <class Scalar>
class NetworkForces {
 public:
  NetworkForces(const SpringNetwork& network, int num_nodes);

  [[nodiscard]] int num_nodes() const { return assembly_.num_nodes(); }

  /// Lengths at the start of a step of time_step [s], > 0; starts: q, 3 x n [m].
  void begin_step(ConstMatrix3XRef<Scalar> starts, Scalar time_step);

  /// forces += those of the network at places x [N], and linearises there.
  void add_forces(ConstMatrix3XRef<Scalar> places, ConstMatrix3XRef<Scalar> starts,
                  Matrix3XRef<Scalar> forces);

  /// What add_forces() is minus the gradient of [J].
  [[nodiscard]] double potential(ConstMatrix3XRef<Scalar> places,
                                 ConstMatrix3XRef<Scalar> starts) const;

  /// product += stiffness displacements [N], with the stiffness of the last add_forces().
  void add_product(ConstMatrix3XRef<float> displacements, Matrix3XRef<float> product);

  /// blocks: 6 x n, the 3 x 3 blocks of the diagonal of that stiffness (xx, yy, zz, xy, yz, zx) [N/m].
  void diagonal_blocks(Eigen::Ref<Eigen::Matrix<float, 6, Eigen::Dynamic>> blocks) const;

 private:
  using Values = VectorX<Scalar>;
  forces::EdgeAssembly assembly_;
  // Of each place in the order of the assembly:
  Values rest_lengths_;
  Values stiffness_;
  Values relief_;  ///< compressed stiffness less stiffness
  Values damping_;
  Values stabiliser_;
  Values start_lengths_;  ///< [m], of edges with damping
  /// sqrt(s - t) u and t, the bits of single-precision numbers. As another type than all that is read
  /// beside them, so that the compiler knows that the two do not overlap, and uses vectors.
  Eigen::Matrix<std::int32_t, Eigen::Dynamic, 4> linear_;
  std::vector<int> place_starts_;  ///< node i has places places_[place_starts_[i]] ...
  std::vector<int> places_;
  Matrix3X<Scalar> scratch_;
  Matrix3X<float> product_scratch_;
  Scalar inverse_time_step_ = 0;
  bool has_damping_ = false;
  bool has_stabiliser_ = false;
};

extern template class NetworkForces<float>;
extern template class NetworkForces<double>;

}  // namespace weft::fast
