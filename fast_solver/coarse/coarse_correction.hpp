#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <utility>
#include <vector>

#include <weft/fast_solver/coarse/bordered_band.hpp>
#include <weft/fast_solver/coarse/coarse_kernel.hpp>
#include <weft/fast_solver/coarse/smoothed_aggregates.hpp>
#include <weft/fast_solver/network/edge_slots.hpp>
#include <weft/fast_solver/network/isotropic_network.hpp>
#include <weft/fast_solver/network/network_kernel.hpp>
#include <weft/fast_solver/network/node_arrays.hpp>
#include <weft/fast_solver/node_constraints.hpp>
#include <weft/fast_solver/simd/aligned_matrix.hpp>
#include <weft/fast_solver/threads/node_parts.hpp>
#include <weft/fast_solver/threads/thread_team.hpp>

namespace weft::fast {

/// Vectors of x, y, z and a number that is not used: what a processor loads and adds at once.
using Fours = AlignedMatrix<float, 4, Eigen::Dynamic>;

/// What a few iterations from node to node cannot carry: P (P^T A P)^-1 P^T residual, with A the linearised network as it is
/// in the present step, and P hats over patches of some tens of nodes (smoothed_aggregates.hpp). Whatever a cloth does
/// slowly and together, it does nearly so: carry a corner's load, swing, fold over an obstacle.
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
  CoarseCorrection(const IsotropicNetwork& network, const EdgeSlots& slots);

  /// The nodes of ring 0 are free if they were not, and the other way round: hats anew for all within kHatReach springs.
  /// rings: up to twice that; network, is_free: of their nodes. set_masses() is due then.
  void set_free(const IsotropicNetwork& network, const Rings& rings,
                const std::vector<bool>& is_free, const EdgeSlots& slots);

  /// Nodes that come behind the others, copies of these: they have their origins' parts.
  void add_copies(const std::vector<int>& origins);
  /// The springs of some blocks of kNodeBlock nodes, flags; and of all that come behind them.
  void note_springs(const EdgeSlots& slots, const std::vector<char>& blocks);

  /// The stiffness of bending between the two nodes of each lane of the slots [N/m], which does not change with the
  /// linearisation. Its terms nearly cancel for smooth shapes: all count, in double precision.
  void set_bending(const EdgeSlots& slots, const std::function<double(std::size_t)>& stiffness);
  /// masses: of each node.
  void set_masses(const VectorX<float>& masses);
  /// For the present linearisation: linear as in NetworkView, root_scale too; holds of each node; inertia over mass.
  void factorise(const unsigned short* linear, float root_scale, const std::vector<Hold>& holds,
                 float inertia_over_mass, ThreadTeam& team);

  /// The restriction of the residual of the nodes of a part. Several calls may run at once.
  void restrict_residual(int part, const std::vector<int>& held, const NodeArrays<float>& residual);
  /// For coarse unknowns, after the residual of all nodes.
  void solve(ThreadTeam& team);
  /// From coarse unknowns to the nodes of a part. Several calls may run at once.
  void interpolate(int part, const std::vector<int>& held, NodeArrays<float>& correction) const;

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
    Range hats;
    Range sums;
    AlignedVector<float> blocks;
    Fours residual;
    Fours other_residual;
  };
  /// Numbers of some hats.
  struct Row {
    struct Entry {
      int hat;
      float number;
    };
    std::array<Entry, 6> entries;  ///< of two nodes at most
    int count = 0;

    [[nodiscard]] const Entry* begin() const { return entries.data(); }
    [[nodiscard]] const Entry* end() const { return entries.data() + count; }
    void add(int hat, float number);
  };

  /// The ties of each hat to higher ones, ascending [N/m].
  using Ties = std::vector<std::vector<std::pair<int, float>>>;

  [[nodiscard]] Row row_of(int node) const;
  [[nodiscard]] Row difference(int node, int other) const;
  [[nodiscard]] int pair_of(int a, int b) const;
  void set_hats(int node, const Interpolation& hats, int unknown);
  [[nodiscard]] Ties ties_of(const IsotropicNetwork& springs, const std::vector<int>& names) const;
  [[nodiscard]] bool counts(int hat, int other, float tie) const;
  void find_pairs(const Ties& ties);
  [[nodiscard]] bool add_pairs(const Ties& ties);
  void make_band();
  void add_terms(const Row& row, std::vector<CoarseTerm>& terms) const;
  void note_alone(int node);
  [[nodiscard]] bool is_in_sample(int node, int slot) const;
  void find_ranges(int part);
  void fill_gaps(NodeRange nodes);

  int num_nodes_ = 0;
  int num_hats_ = 0;
  double springs_for_one_ = 1;  ///< that one in the sample stands for
  NodeParts parts_;
  Patches patches_;
  std::vector<HatWeights> weights_;
  std::vector<float> largest_ties_;         ///< of each hat
  std::vector<std::pair<int, int>> pairs_;  ///< of hats, ascending
  std::vector<int> first_pairs_;            ///< of each hat as the lower one, and behind the last
  std::vector<Block> blocks_;
  std::vector<CoarseNode> alone_;  ///< of each node
  BorderedBand band_;
  std::vector<Part> of_parts_;
  AlignedVector<float> sums_;     ///< blocks, of all parts
  std::vector<float> bending_;    ///< of blocks, the same in all directions; empty: none
  AlignedVector<float> masses_;   ///< of hats
  AlignedVector<float> inertia_;  ///< likewise
  std::vector<BorderedBand::Summand> residuals_;  ///< in of_parts_
  Fours solution_;                                ///< of hats
};

}  // namespace weft::fast
