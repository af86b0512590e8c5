#pragma once

namespace weft::bench {

/// Springs as bare arrays: what floor_kernel.cpp, compiled for AVX2, may see. No other header, so
/// that no inline function of another library is compiled for AVX2 behind its back.
template <class Scalar>
struct FloorArrays {
  int num_springs;
  int num_nodes;
  Scalar stiffness;            ///< [N/m]
  const Scalar* rest_lengths;  ///< [m] num_springs
  const Scalar* differences;   ///< [m] 3 x num_springs, component by component
  Scalar* spring_forces;       ///< [N] likewise, output of evaluate_springs
  const int* first;            ///< num_springs
  const int* second;           ///< num_springs
  const Scalar* positions;     ///< [m] 3 x num_nodes, component by component
  const int* run_begins;  ///< num_runs + 1: springs whose first and second nodes follow each other
  int num_runs;
  Scalar* node_forces;  ///< [N] likewise, added to by gather_evaluate_scatter
};

/// Whether this processor can run the functions below.
[[nodiscard]] bool has_avx2_and_fma();

/// The pure evaluation: differences and rest lengths in, forces out, springs [begin, end).
template <class Scalar>
void evaluate_springs(const FloorArrays<Scalar>& arrays, int begin, int end);

/// With the differences fetched from the nodes and the forces added to the nodes.
template <class Scalar>
void gather_evaluate_scatter(const FloorArrays<Scalar>& arrays, Scalar* node_forces, int begin,
                             int end);

/// Likewise for runs [begin, end), with whole vectors loaded and stored: only on a grid, whose springs
/// lie in runs.
template <class Scalar>
void evaluate_runs(const FloorArrays<Scalar>& arrays, Scalar* node_forces, int begin, int end);

}  // namespace weft::bench
