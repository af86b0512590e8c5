#pragma once

namespace weft::fast {

/// One neighbour for each node of a block (edge_slots.hpp).
struct EdgeSlot {
  int offset;         ///< neighbour minus node; 0 if scattered
  bool is_scattered;  ///< neighbours are fetched one by one
};

/// The slots of a block of nodes: begin ... rows_end - 1 have their neighbours in a row, rows_end ... end - 1 are
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
  const Scalar* springs;      ///< rest length, stiffness, what compression adds to the stiffness
  const Scalar* dampers;      ///< damping / time step, length at the start; nullptr: none
  const Scalar* stabilisers;  ///< w; nullptr: none
  Scalar least_across;        ///< t over s at least
  float root_scale;           ///< square root of what the stiffness is multiplied by to be stored
  /// sqrt(s - t) u and t, of the stiffness s u u^T + t (I - u u^T) of an edge of direction u, in half precision: what a
  /// correction is off by is small beside what one step of Newton's method leaves
  unsigned short* linear;
};

/// The inner loops over the blocks begin ... end - 1. What they write: these blocks' nodes only.
template <class Scalar>
struct NetworkKernel {
  /// forces += those at places; linearises there. diagonal, six arrays: the blocks of the stiffness.
  void (*forces)(const NetworkView<Scalar>& network, int begin, int end, const Scalar* places,
                 const Scalar* starts, Scalar* forces, float* diagonal);
  /// product = inertia displacements + stiffness displacements
  void (*multiply)(const NetworkView<Scalar>& network, int begin, int end, const float* inertia,
                   const float* displacements, float* product);
  /// [J]
  double (*energy)(const NetworkView<Scalar>& network, int begin, int end, const Scalar* places,
                   const Scalar* starts);
};

/// Sums over arrays of nodes, in double precision but for short pieces.
template <class Scalar>
struct SumKernel {
  struct Sums {
    double first;
    double second;
  };
  /// a . a over `size` numbers, a multiple of kNodeBlock.
  double (*squares)(const Scalar* a, long size);
  /// a . step over `size` numbers.
  double (*dot)(const Scalar* a, const float* step, long size);
  /// The same, and places += step.
  double (*move)(const Scalar* a, const float* step, long size, Scalar* places);
  /// Sum of weight |a - b|^2 over the nodes of arrays of `stride`.
  double (*weighted_distance)(const Scalar* weights, long stride, const Scalar* a, const Scalar* b);
  /// Sums of weight |a - b|^2 and of |a - b| |forces|.
  Sums (*motion)(const Scalar* weights, long stride, const Scalar* a, const Scalar* b,
                 const Scalar* forces);
};

/// Loops of conjugate gradients over arrays of `size` numbers, a multiple of kNodeBlock.
struct VectorKernel {
  struct Products {
    float first;
    float second;
  };
  /// blocks = share (blocks + inertia)^-1, node by node; 0 where there is none.
  void (*invert_blocks)(const float* inertia, float share, int stride, float* blocks);
  /// result = blocks vectors, node by node: 3 arrays from 6, of `stride` nodes each.
  void (*multiply_blocks)(const float* blocks, int stride, const float* vectors, float* result);
  /// result = a - b
  void (*subtract)(const float* a, const float* b, long size, float* result);
  /// correction += more, product += more_product. Returns correction . residual and
  /// correction . direction_product.
  Products (*add_correction)(const float* more, const float* more_product, const float* residual,
                             const float* direction_product, long size, float* correction,
                             float* product);
  /// direction = correction - share direction, the same for its product. Returns direction . product and
  /// direction . residual.
  Products (*turn)(const float* correction, const float* correction_product, const float* residual,
                   float share, long size, float* direction, float* product);
  /// step += length direction, residual -= length product
  void (*advance)(const float* direction, const float* product, float length, long size,
                  float* step, float* residual);
  /// x, y, z and a zero of each node in a row, from arrays of `stride` nodes, and back.
  void (*to_fours)(const float* arrays, long stride, float* fours);
  void (*from_fours)(const float* fours, long stride, float* arrays);
};

/// The fastest that this processor runs. Same results in every call, but not those of another
/// processor: AVX2 brings fused operations, and each maker has its own estimate of a root.
template <class Scalar>
[[nodiscard]] const NetworkKernel<Scalar>& network_kernel();
template <class Scalar>
[[nodiscard]] const SumKernel<Scalar>& sum_kernel();
[[nodiscard]] const VectorKernel& vector_kernel();

}  // namespace weft::fast
