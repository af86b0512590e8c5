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

/// Rows of the upper factor U of a matrix that is a band with a border, three rows for each unknown. A row of an unknown
/// begins at the unknown's own column: near numbers, the rest of which are zeros, then those of the border.
struct BandRows {
  float* values;
  float* diagonal;  ///< of each unknown, six: inverses of U's diagonal, then u01, u02, u12
  int num_near;     ///< kRowPad zeros and more included
  int num_border;   ///< multiple of kRowPad, filled up with zeros
  int stride;       ///< of rows: both together
  int width;        ///< unknowns that a row reaches, its own included
};

/// A node's part in hats; without one: weights of 0.
struct HatWeights {
  int hats[3] = {0, 0, 0};
  float weights[3] = {0, 0, 0};
};

struct CoarseKernel {
  /// sums[term.sum] += term.factor stiffness, for each term of each spring; those of its other end alone where one end is
  /// held, none where both are.
  void (*add_springs)(const CoarseSprings& springs, float* sums);
  /// Makes the factor of num unknowns, which reach none behind them but the border's. corner: what they take from the block
  /// of the border, rows of num_border numbers, upper half. An unknown with a pivot below `least` of what is stored for it in
  /// diagonal gets no part in solutions.
  void (*factorise)(const BandRows& rows, int num, float least, float* corner);
  /// vector = U^-T vector for these unknowns; border -= what they leave for it.
  void (*go_up)(const BandRows& rows, int num, float* vector, float* border);
  /// vector = U^-1 vector, where border has the border's solution.
  void (*go_down)(const BandRows& rows, int num, float* vector, const float* border);
  /// sums and other_sums, in fours, += weights of nodes times the nodes' values, from sum first_sum on: what is wanted is the
  /// sum of both.
  void (*restrict_to)(const HatWeights* weights, int begin, int end, const float* values,
                      long stride, int first_sum, float* sums, float* other_sums);
  /// The transpose: values of nodes from fours.
  void (*interpolate)(const HatWeights* weights, int begin, int end, const float* fours,
                      float* values, long stride);
};

/// The fastest that this processor runs, as in network_kernel.hpp.
[[nodiscard]] const CoarseKernel& coarse_kernel();

}  // namespace weft::fast
