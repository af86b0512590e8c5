#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include <weft/fast_solver/coarse/coarse_kernel.hpp>
#include <weft/fast_solver/coarse/coarse_row.hpp>
#include <weft/fast_solver/coarse/dissected_cholesky.hpp>
#include <weft/fast_solver/coarse/smoothed_aggregation.hpp>
#include <weft/fast_solver/network/connectivity_graph.hpp>
#include <weft/fast_solver/network/edge_slots.hpp>
#include <weft/fast_solver/network/network_kernel.hpp>
#include <weft/fast_solver/network/node_arrays.hpp>
#include <weft/fast_solver/node_constraints.hpp>
#include <weft/fast_solver/shared_value.hpp>
#include <weft/fast_solver/simd/aligned_matrix.hpp>
#include <weft/fast_solver/threads/node_partition.hpp>
#include <weft/fast_solver/threads/worker_team.hpp>

namespace weft::fast {

/// Vectors of x, y, z and a number that is not used: what a processor loads and adds at once.
using Fours = AlignedMatrix<float, 4, Eigen::Dynamic>;

/// The coarse level of the preconditioner: P (P^T A P)^-1 P^T residual, with A the linearized network of the present step and P
/// the coarse basis functions of smoothed aggregation (Vanek, Mandel and Brezina 1996; smoothed_aggregation.hpp). It carries
/// what block Jacobi cannot: slow motions of the whole cloth, such as swinging or bearing a load at a corner. The Galerkin
/// matrix P^T A P is assembled from a sample of the springs, which is enough to know the couplings (kSpringsOfBasis).
///
/// Nodes that cannot move have no weight in P.
/// Threads  one object from one thread at a time, except where a function says otherwise. Memory is allocated only by the
///          constructor, set_free(), add_copies() and note_springs().
class CoarseCorrection {
 public:
  CoarseCorrection() = default;
  /// network: all nodes, which are free. slots: of the same springs. set_masses() is due then.
  CoarseCorrection(const ConnectivityGraph& network, const EdgeSlots& slots);

  /// Toggles whether the nodes of ring 0 are free, and recomputes the coarse basis functions within kBasisReach springs of them.
  /// neighborhood: rings up to twice that; network, is_free: for its nodes. couple() must be called afterwards.
  void set_free(const ConnectivityGraph& network, const Neighborhood& neighborhood,
                const std::vector<bool>& is_free, const EdgeSlots& slots);
  /// Couples basis functions as the free network does, and where the surroundings of constrained nodes need more: without
  /// couplings of nodes that are free again, so that the bits do not depend on what was constrained before. network: for the
  /// nodes within 2 kBasisReach springs of all that are constrained. set_masses() must be called afterwards.
  void couple(const ConnectivityGraph& network, const std::vector<int>& nodes,
              const EdgeSlots& slots);

  /// Appends copies of these nodes behind the others. A copy has the weights of its origin.
  void add_copies(const std::vector<int>& origins);
  /// The springs of some blocks of kNodeBlock nodes, flags; and of all that come behind them.
  void note_springs(const EdgeSlots& slots, const std::vector<char>& blocks);

  /// The stiffness of bending between the two nodes of each lane of the slots [N/m], which does not change with the
  /// linearization. Its terms nearly cancel for smooth shapes: all count, in double precision.
  void set_bending(const EdgeSlots& slots, const std::function<double(std::size_t)>& stiffness);
  /// masses: of each node.
  void set_masses(const VectorX<float>& masses);
  /// Assembles and factorizes P^T A P. linear and root_scale are those of NetworkView; is_held says of each node whether it
  /// has no part: it does not move, or with a body.
  void factorize(const unsigned short* linear, float root_scale, std::span<const char> is_held,
                 std::span<const SlidingNode> sliding, float inertia_over_mass, WorkerTeam& team);

  /// Declares that all nodes can translate together across `normal` without strain, and their total `inertia` [N/m]; an inertia of
  /// 0 declares that they cannot. The translation is solved for apart from the coarse matrix, because single precision loses its
  /// inertia there beside stiff springs.
  void set_translation(float inertia, const Vector3<float>& normal) {
    translation_inertia_ = inertia;
    translation_normal_ = normal;
  }

  /// Restriction: the residual of one node range. Calls for different ranges may run at the same time.
  void restrict_residual(int part, const std::vector<int>& held, const NodeArrays<float>& residual);
  /// Solves for the coarse coefficients, after restrict_residual() of all ranges.
  void solve(WorkerTeam& team);
  /// Prolongation: the correction of one node range. Calls for different ranges may run at the same time.
  void prolongate(int part, const std::vector<int>& held, NodeArrays<float>& correction) const;

 private:
  /// The springs of a block of nodes.
  struct Block {
    std::vector<CoarseSpring> springs;
    std::vector<CoarseTerm> terms;
  };
  /// begin ... end - 1
  struct Range {
    int begin = 0;
    int end = 0;
  };
  /// The contribution of one node range to the coarse system.
  struct Part {
    Range basis_functions;
    Range sums;
    AlignedVector<float> blocks;
    Fours residual;
    Fours other_residual;
  };
  using Row = CoarseRow;

  /// The couplings of each coarse basis function to higher ones, ascending [N/m].
  using Couplings = std::vector<std::vector<std::pair<int, float>>>;

  [[nodiscard]] Row row_of(int node) const;
  [[nodiscard]] Row difference(int node, int other) const;
  [[nodiscard]] int pair_of(int a, int b) const;
  void set_basis_weights(int node, const Prolongation& basis_functions, int unknown);
  [[nodiscard]] Couplings couplings_of(const ConnectivityGraph& springs,
                                       const std::vector<int>& node_ids) const;
  [[nodiscard]] bool is_strong(int basis, int other, float coupling) const;
  void find_pairs(const Couplings& couplings);
  void make_factor();
  void add_terms(const Row& of_spring, std::vector<CoarseTerm>& terms) const;
  void note_alone(int node);
  [[nodiscard]] bool is_in_sample(int node, int slot) const;
  void find_ranges(int part);
  void fill_gaps(NodeRange nodes);
  void split_translation();
  void join_translation();

  int num_nodes_ = 0;
  int num_basis_ = 0;
  double springs_for_one_ = 1;  ///< the number of springs that one in the sample stands for
  NodePartition parts_;
  Aggregates aggregates_;
  std::vector<BasisWeights> weights_;
  std::vector<float> largest_couplings_;            ///< for each coarse basis function
  std::vector<std::pair<int, int>> pairs_;          ///< for coarse basis functions, ascending
  std::vector<std::pair<int, int>> pairs_of_free_;  ///< those of the free network, ascending
  std::vector<int>
      first_pairs_;  ///< for each coarse basis function as the lower one, and behind the last
  SharedValue<std::vector<Block>> blocks_;
  SharedValue<std::vector<CoarseNode>> alone_;  ///< for each node
  DissectedCholesky factor_;
  std::vector<Part> of_parts_;
  AlignedVector<float> sums_;      ///< blocks, of all parts
  std::vector<float> bending_;     ///< for blocks, the same in all directions; empty: none
  AlignedVector<float> masses_;    ///< for coarse basis functions
  AlignedVector<float> inertia_;   ///< for coarse basis functions [N/m]
  Fours solution_;                 ///< for coarse basis functions
  float translation_inertia_ = 0;  ///< [N/m]
  Vector3<float> translation_normal_{0, 0, 0};
  Vector3<float> translation_{0, 0, 0};  ///< [m]
  Fours translation_residual_;           ///< for coarse basis functions: minus that of it
};

}  // namespace weft::fast
