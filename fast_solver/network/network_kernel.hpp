#pragma once

// Tested by tests/fast_solver/network/spring_network_test.cpp, tests/fast_solver/implicit_solver_test.cpp.

namespace weft::fast {

/// Nodes begin ... end - 1, both multiples of kNodeBlock.
struct NodeRange {
  int begin;
  int end;
};

/// One neighbor for each node of a block (edge_slots.hpp).
struct EdgeSlot {
  int offset;         ///< neighbor minus node; 0 if scattered
  bool is_scattered;  ///< neighbors are fetched one by one
};

/// The slots of a block of nodes: begin ... rows_end - 1 have their neighbors in a row, rows_end ... end - 1 are
/// scattered.
struct SlotRange {
  int begin;
  int rows_end;
  int end;
};

/// A network in slots. Arrays of nodes have stride numbers per component; arrays of slots have
/// kNodeBlock numbers per slot and quantity. Empty lanes have stiffness 0 and rest length 1.
template <class Scalar>
struct NetworkView {
  const SlotRange* blocks;
  const EdgeSlot* slots;
  const int* others;
  int stride;
  const Scalar* springs;    ///< rest length, stiffness, what compression adds to the stiffness
  const Scalar* dampers;    ///< damping / time step, length at the start; nullptr: none
  const float* bending;     ///< w of the matrix; nullptr: none
  Scalar least_transverse;  ///< t over s at least
  float root_scale;         ///< square root of what the stiffness is multiplied by to be stored
  /// sqrt(s - t) u and t, of the stiffness s u u^T + t (I - u u^T) of an edge of direction u, in half precision: what a
  /// correction is off by is small beside what one step of Newton's method leaves
  unsigned short* linear;
};

/// The inner loops over some nodes. What they write: these nodes only.
template <class Scalar>
struct NetworkKernel {
  /// dampers = damping / time step and length of each lane.
  void (*note_lengths)(const NetworkView<Scalar>& network, NodeRange nodes, const Scalar* starts,
                       const Scalar* damping, Scalar time_step, Scalar* dampers);
  /// forces += those at positions; linearizes there. diagonal, six arrays: the blocks of the stiffness; without them
  /// the linearization stays as it was.
  void (*forces)(const NetworkView<Scalar>& network, NodeRange nodes, const Scalar* positions,
                 Scalar* forces, float* diagonal);
  /// product = inertia displacements + stiffness displacements
  void (*multiply)(const NetworkView<Scalar>& network, NodeRange nodes, const float* inertia,
                   const float* displacements, float* product);
  /// [J]
  double (*energy)(const NetworkView<Scalar>& network, NodeRange nodes, const Scalar* positions);
};

/// Sums over some nodes, in double precision except for short runs. Arrays of nodes have `stride` numbers per
/// component.
template <class Scalar>
struct SumKernel {
  /// a . a
  double (*squares)(const Scalar* a, int stride, NodeRange nodes);
  /// a . step
  double (*dot)(const Scalar* a, const float* step, int stride, NodeRange nodes);
  /// The same, and positions += step.
  double (*move)(const Scalar* a, const float* step, int stride, NodeRange nodes,
                 Scalar* positions);
  /// Sum of weight |a - b|^2.
  double (*weighted_distance)(const Scalar* weights, int stride, NodeRange nodes, const Scalar* a,
                              const Scalar* b);
  /// Sum of |a - b| |forces|.
  double (*possible_work)(int stride, NodeRange nodes, const Scalar* a, const Scalar* b,
                          const Scalar* forces);
};

/// Loops of conjugate gradients over some nodes.
struct VectorKernel {
  struct Products {
    float by_residual;
    float by_direction;
    float by_product;
  };
  /// inverse = share (blocks + inertia)^-1, pointwise; 0 where there is none.
  void (*invert_blocks)(const float* inertia, float share, int stride, NodeRange nodes,
                        const float* blocks, float* inverse);
  /// result = blocks vectors, node by node: 3 arrays from 6.
  void (*multiply_blocks)(const float* blocks, int stride, NodeRange nodes, const float* vectors,
                          float* result);
  /// sum = one + other.
  void (*add)(const float* one, const float* other, int stride, NodeRange nodes, float* sum);
  /// correction . residual, correction . direction_product and correction . product. direction_product: nullptr if there
  /// is none; its product is 0 then.
  Products (*dot_products)(const float* correction, const float* product, const float* residual,
                           const float* direction_product, int stride, NodeRange nodes);
  /// direction_product = correction_product - beta direction_product, residual -= alpha direction_product.
  /// is_first: there is no direction before, and direction_product is not read.
  void (*advance)(const float* correction_product, float beta, float alpha, bool is_first,
                  int stride, NodeRange nodes, float* direction_product, float* residual);
  /// sum = own_weight sum + weights_k vectors_k, k = 0 ... count - 1; unchanged for a count of 0. Not read for an own_weight
  /// of 0.
  void (*add_vectors)(const float* const* vectors, const float* weights, int count,
                      float own_weight, int stride, NodeRange nodes, float* sum);
};

/// The fastest that this processor runs. Same results in every call, but not those of another
/// processor: AVX2 brings fused operations, and each maker has its own estimate of a root.
template <class Scalar>
[[nodiscard]] const NetworkKernel<Scalar>& network_kernel();
template <class Scalar>
[[nodiscard]] const SumKernel<Scalar>& sum_kernel();
[[nodiscard]] const VectorKernel& vector_kernel();

}  // namespace weft::fast
