#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <utility>
#include <vector>

#include <weft/fast_solver/coarse/coarse_kernel.hpp>
#include <weft/fast_solver/coarse/dissected_cholesky.hpp>
#include <weft/fast_solver/coarse/smoothed_aggregation.hpp>
#include <weft/fast_solver/network/connectivity_graph.hpp>
#include <weft/fast_solver/network/edge_slots.hpp>
#include <weft/fast_solver/network/network_kernel.hpp>
#include <weft/fast_solver/network/node_arrays.hpp>
#include <weft/fast_solver/node_constraints.hpp>
#include <weft/fast_solver/simd/aligned_matrix.hpp>
#include <weft/fast_solver/threads/node_partition.hpp>
#include <weft/fast_solver/threads/worker_team.hpp>

namespace weft::fast {

/// Vectors of x, y, z and a number that is not used: what a processor loads and adds at once.
using Fours = AlignedMatrix<float, 4, Eigen::Dynamic>;

/// What a few iterations from node to node cannot carry: P (P^T A P)^-1 P^T residual, with A the linearized network as it is
/// in the present step, and P coarse basis functions over aggregates of some tens of nodes (smoothed_aggregation.hpp). Whatever a cloth does
/// slowly and together, it does nearly so: carry a corner's load, swing, fold over a collider.
///
/// Nodes that are held have no part in P.
/// Threads  one object from one thread at a time, but for calls that say otherwise. Allocates nothing after construction, but
///          for set_free(), add_copies() and note_springs().
class CoarseCorrection {
 public:
  CoarseCorrection() = default;
  CoarseCorrection(const CoarseCorrection&) = delete;  // residuals_ would be those of the other one
  CoarseCorrection& operator=(const CoarseCorrection&) = delete;
  CoarseCorrection(CoarseCorrection&&) = default;
  CoarseCorrection& operator=(CoarseCorrection&&) = default;
  ~CoarseCorrection() = default;
  /// network: all nodes, which are free. slots: of the same springs. set_masses() is due then.
  CoarseCorrection(const ConnectivityGraph& network, const EdgeSlots& slots);

  /// The nodes of ring 0 are free if they were not, and the other way round: coarse basis functions anew for all within kBasisReach springs.
  /// rings: up to twice that; network, is_free: of their nodes. set_masses() is due then.
  void set_free(const ConnectivityGraph& network, const Neighborhood& neighborhood,
                const std::vector<bool>& is_free, const EdgeSlots& slots);

  /// Nodes that come behind the others, copies of these: they have their origins' parts.
  void add_copies(const std::vector<int>& origins);
  /// The springs of some blocks of kNodeBlock nodes, flags; and of all that come behind them.
  void note_springs(const EdgeSlots& slots, const std::vector<char>& blocks);

  /// The stiffness of bending between the two nodes of each lane of the slots [N/m], which does not change with the
  /// linearization. Its terms nearly cancel for smooth shapes: all count, in double precision.
  void set_bending(const EdgeSlots& slots, const std::function<double(std::size_t)>& stiffness);
  /// masses: of each node.
  void set_masses(const VectorX<float>& masses);
  /// For the present linearization: linear as in NetworkView, root_scale too; holds of each node; inertia over mass.
  void factorize(const unsigned short* linear, float root_scale,
                 const std::vector<ContactState>& holds, float inertia_over_mass, WorkerTeam& team);

  /// The restriction of the residual of the nodes of a part. Several calls may run at once.
  void restrict_residual(int part, const std::vector<int>& constrained,
                         const NodeArrays<float>& residual);
  /// For coarse unknowns, after the residual of all nodes.
  void solve(WorkerTeam& team);
  /// From coarse unknowns to the nodes of a part. Several calls may run at once.
  void prolongate(int part, const std::vector<int>& constrained,
                  NodeArrays<float>& correction) const;

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
  /// What the nodes of a part add up.
  struct Part {
    Range basis_functions;
    Range sums;
    AlignedVector<float> blocks;
    Fours residual;
    Fours other_residual;
  };
  /// Numbers of some coarse basis functions.
  struct Row {
    struct Entry {
      int basis;
      float coefficient;
    };
    std::array<Entry, 6> entries;  ///< of two nodes at most
    int count = 0;

    [[nodiscard]] const Entry* begin() const { return entries.data(); }
    [[nodiscard]] const Entry* end() const { return entries.data() + count; }
    void add(int basis, float coefficient);
  };

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
  [[nodiscard]] bool add_pairs(const Couplings& couplings);
  void make_factor();
  void add_terms(const Row& row, std::vector<CoarseTerm>& terms) const;
  void note_alone(int node);
  [[nodiscard]] bool is_in_sample(int node, int slot) const;
  void find_ranges(int part);
  void fill_gaps(NodeRange nodes);

  int num_nodes_ = 0;
  int num_basis_ = 0;
  double springs_for_one_ = 1;  ///< that one in the sample stands for
  NodePartition parts_;
  Aggregates aggregates_;
  std::vector<BasisWeights> weights_;
  std::vector<float> largest_couplings_;    ///< of each coarse basis function
  std::vector<std::pair<int, int>> pairs_;  ///< of coarse basis functions, ascending
  std::vector<int>
      first_pairs_;  ///< of each coarse basis function as the lower one, and behind the last
  std::vector<Block> blocks_;
  std::vector<CoarseNode> alone_;  ///< of each node
  DissectedCholesky factor_;
  std::vector<Part> of_parts_;
  AlignedVector<float> sums_;     ///< blocks, of all parts
  std::vector<float> bending_;    ///< of blocks, the same in all directions; empty: none
  AlignedVector<float> masses_;   ///< of coarse basis functions
  AlignedVector<float> inertia_;  ///< likewise
  std::vector<DissectedCholesky::Summand> residuals_;  ///< in of_parts_
  Fours solution_;                                     ///< of coarse basis functions
};

}  // namespace weft::fast
