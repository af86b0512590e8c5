#pragma once

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
  float share;  ///< that the others like it have
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
  const CoarseTerm* terms;  ///< of all springs, one after the other
  const CoarseNode* nodes;
  const unsigned char* is_held;  ///< of each node
  const unsigned short* linear;
  float scale;    ///< of what is stored
  int first_sum;  ///< of those that are given
};

/// Rows of the upper factor U of a matrix that is a band with a separator, three rows for each unknown. A row of an unknown
/// begins at the unknown's own column: near numbers, the rest of which are zeros, then those of the separator.
struct FactorRows {
  float* values;
  float* diagonal;    ///< of each unknown, six: inverses of U's diagonal, then u01, u02, u12
  int num_near;       ///< kRowPad zeros and more included
  int num_separator;  ///< multiple of kRowPad, filled up with zeros
  int stride;         ///< of rows: both together
  int width;          ///< unknowns that a row reaches, its own included
};

/// A node's part in coarse basis functions; without one: weights of 0.
struct BasisWeights {
  int basis_functions[3] = {0, 0, 0};
  float weights[3] = {0, 0, 0};
};

struct CoarseKernel {
  /// sums[term.sum] += term.factor stiffness, for each term of each spring; those of its other end alone where one end is
  /// held, none where both are.
  void (*add_springs)(const CoarseSprings& springs, float* sums);
  /// Makes the factor of num unknowns, which reach none behind them but the separator's. corner: what they take from the block
  /// of the separator, rows of num_separator numbers, upper half. An unknown with a pivot below `least` of what is stored for it in
  /// diagonal gets no part in solutions.
  void (*factorize)(const FactorRows& rows, int num, float least, float* schur_complement);
  /// vector = U^-T vector for these unknowns; separator -= what they leave for it.
  void (*forward_substitute)(const FactorRows& rows, int num, float* vector, float* separator);
  /// vector = U^-1 vector, where separator has the separator's solution.
  void (*backward_substitute)(const FactorRows& rows, int num, float* vector,
                              const float* separator);
  /// sums and other_sums, in fours, += weights of nodes times the nodes' values, from sum first_sum on: what is wanted is the
  /// sum of both.
  void (*restrict_residual)(const BasisWeights* weights, int begin, int end, const float* values,
                            long stride, int first_sum, float* sums, float* other_sums);
  /// The transpose: values of nodes from fours.
  void (*prolongate)(const BasisWeights* weights, int begin, int end, const float* fours,
                     float* values, long stride);
};

/// The fastest that this processor runs, as in network_kernel.hpp.
[[nodiscard]] const CoarseKernel& coarse_kernel();

}  // namespace weft::fast
