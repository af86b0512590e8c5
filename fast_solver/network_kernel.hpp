#pragma once

namespace weft::fast {

/// One neighbour for each node of a block (edge_slots.hpp).
struct EdgeSlot {
  int offset;         ///< neighbour minus node; 0 if scattered
  bool is_scattered;  ///< neighbours are fetched one by one
  bool is_mutual;     ///< neighbours get the opposite force
};

/// A network in slots. Arrays of nodes have stride numbers per component; arrays of slots have
/// kNodeBlock numbers per slot and quantity. Empty lanes have stiffness 0 and rest length 1.
template <class Scalar>
struct NetworkView {
  const int* block_starts;
  const EdgeSlot* slots;
  const int* others;
  int stride;
  const Scalar* springs;      ///< rest length, stiffness, what compression adds to the stiffness
  const Scalar* dampers;      ///< damping / time step, length at the start; nullptr: none
  const Scalar* stabilisers;  ///< w; nullptr: none
  /// sqrt(s - t) u and t, of the stiffness s u u^T + t (I - u u^T) of an edge of direction u
  float* linear;
};

/// The inner loops over the blocks begin ... end - 1. What they write: these blocks' nodes only.
template <class Scalar>
struct NetworkKernel {
  /// forces += those at places; linearises there.
  void (*forces)(const NetworkView<Scalar>& network, int begin, int end, const Scalar* places,
                 const Scalar* starts, Scalar* forces);
  /// product = inertia displacements + stiffness displacements
  void (*multiply)(const NetworkView<Scalar>& network, int begin, int end, const float* inertia,
                   const float* displacements, float* product);
  /// blocks, six arrays: the diagonal of the stiffness
  void (*blocks)(const NetworkView<Scalar>& network, int begin, int end, float* blocks);
  /// [J]
  double (*energy)(const NetworkView<Scalar>& network, int begin, int end, const Scalar* places,
                   const Scalar* starts);
};

/// result = blocks vectors, node by node, for nodes begin ... end - 1, multiples of kNodeBlock.
using BlockProduct = void (*)(const float* blocks, int stride, int begin, int end,
                              const float* vectors, float* result);

/// The fastest that this processor runs. Same results in every call, but not those of another
/// processor: AVX2 brings fused operations.
template <class Scalar>
[[nodiscard]] const NetworkKernel<Scalar>& network_kernel();
[[nodiscard]] BlockProduct block_product();

}  // namespace weft::fast
