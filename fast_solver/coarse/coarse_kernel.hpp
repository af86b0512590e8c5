#pragma once

// Tested by tests/fast_solver/coarse/coarse_correction_test.cpp, tests/fast_solver/coarse/dissected_cholesky_test.cpp.

namespace weft::fast {

/// Numbers of a symmetric 3 x 3 block: xx, yy, zz, xy, yz, zx and two that are not used.
inline constexpr int kBlockNumbers = 8;
/// Zeros behind what is added up in whole vectors.
inline constexpr int kRowPad = 16;

/// Part of a sum of blocks: factor times a spring's stiffness.
struct CoarseTerm {
  int sum;
  float factor;
};

/// A spring, at its end of the lower number, and how many terms it has.
struct CoarseSpring {
  int slot;
  int lane;
  int node;
  int other;
  int num_terms;
  float share;  ///< the number of springs that it stands for in the sample
};

/// The terms of a spring whose other end is held.
struct CoarseNode {
  CoarseTerm terms[6];
  int num_terms;
};

/// The springs of some nodes, and the stiffness that network_kernel.hpp has stored for them.
struct CoarseSprings {
  const CoarseSpring* springs;
  int num_springs;
  const CoarseTerm* terms;  ///< for all springs, one after the other
  const CoarseNode* nodes;
  const char* is_held;  ///< for each node
  const unsigned short* linear;
  float scale;    ///< of what is stored
  int first_sum;  ///< of those that are given
};

/// Rows of the upper factor U of a subdomain, three for each unknown. A row starts at its unknown's own column: first the band,
/// padded with zeros, then the columns of the separator.
struct FactorRows {
  float* values;
  float* diagonal;    ///< for each unknown, six: inverses of U's diagonal, then u01, u02, u12
  int num_near;       ///< kRowPad zeros and more included
  int num_separator;  ///< multiple of kRowPad, padded with zeros
  int stride;         ///< for rows: both together
  int width;          ///< unknowns that a row reaches, its own included
};

/// The weights of a node in coarse basis functions. Unused entries have the weight 0.
struct BasisWeights {
  int basis_functions[3] = {0, 0, 0};
  float weights[3] = {0, 0, 0};
};

struct CoarseKernel {
  /// sums[term.sum] += term.factor stiffness, for each term of each spring; those of its other end alone where one end is
  /// held, none where both are.
  void (*add_springs)(const CoarseSprings& springs, float* sums);
  /// Makes the factor of num unknowns, which reach none behind them but the separator's. schur_complement: what they take from the block
  /// of the separator, rows of num_separator numbers, upper half. An unknown with a pivot below `least` of what is stored for it in
  /// diagonal gets no part in solutions.
  void (*factorize)(const FactorRows& rows, int num, float least, float* schur_complement);
  /// Forward substitution: vector = U^-T vector, and separator -= the contribution of these unknowns.
  void (*forward_substitute)(const FactorRows& rows, int num, float* vector, float* separator);
  /// Backward substitution: vector = U^-1 vector, where separator holds the separator's solution.
  void (*backward_substitute)(const FactorRows& rows, int num, float* vector,
                              const float* separator);
  /// sums and other_sums, in fours, += weights of nodes times the nodes' values, from sum first_sum on: what is wanted is the
  /// sum of both.
  void (*restrict_residual)(const BasisWeights* weights, int begin, int end, const float* values,
                            long stride, int first_sum, float* sums, float* other_sums);
  /// Prolongation, the transpose: values of nodes from coarse coefficients in fours.
  void (*prolongate)(const BasisWeights* weights, int begin, int end, const float* fours,
                     float* values, long stride);
};

/// The fastest that this processor runs, as in network_kernel.hpp.
[[nodiscard]] const CoarseKernel& coarse_kernel();

}  // namespace weft::fast
