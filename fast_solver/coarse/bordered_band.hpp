#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include <weft/fast_solver/coarse/coarse_kernel.hpp>
#include <weft/fast_solver/simd/aligned_matrix.hpp>
#include <weft/fast_solver/threads/thread_team.hpp>

namespace weft::fast {

/// The Cholesky factor of a matrix of 3 x 3 blocks that is made anew again and again, in single precision: a border that
/// parts the unknowns into two halves, each of them a band. The halves are independent work.
/// Threads  one object from one thread at a time, and on a team. Allocates nothing after construction.
class BorderedBand {
 public:
  BorderedBand() = default;
  /// pairs: unknowns between which there are blocks, the lower one first, ascending.
  BorderedBand(int num_unknowns, const std::vector<std::pair<int, int>>& pairs);

  [[nodiscard]] int size() const { return static_cast<int>(places_.size()); }
  [[nodiscard]] int num_blocks() const { return size() + static_cast<int>(pairs_.size()); }
  /// Behind those of lower unknowns there is an unknown's own block, and those of pairs of which it is the lower one.
  [[nodiscard]] int own_block(int unknown) const {
    return first_pairs_[static_cast<std::size_t>(unknown)] + unknown;
  }
  [[nodiscard]] int pair_block(int pair) const {
    return pair + pairs_[static_cast<std::size_t>(pair)].first + 1;
  }

  /// blocks: kBlockNumbers numbers of the stiffness of springs, between the two of each pair (pair_block()) and between an
  /// unknown and what does not move (own_block()). inertia: of each unknown, added to its diagonal.
  void factorise(const float* blocks, const float* inertia, ThreadTeam& team);
  /// Part of a right-hand side: four numbers, the last of which is not used, of each of the unknowns begin ... end - 1.
  struct Summand {
    const float* numbers;
    int begin;
    int end;
  };
  /// solution = A^-1 (sum of right), four numbers of each unknown.
  void solve(std::span<const Summand> right, float* solution, ThreadTeam& team);

 private:
  /// Unknowns begin ... end - 1 of the order; without a border for the border itself.
  struct Band {
    int begin = 0;
    int end = 0;
    int width = 1;
    int lowest = 0;  ///< unknowns: lowest ... highest - 1, and others between them
    int highest = 0;
    AlignedVector<float> values;
    AlignedVector<float> diagonal;
    AlignedVector<float> vector;
    AlignedVector<float> corner;
    AlignedVector<float> border;
    std::vector<int> pairs;  ///< that it has a block for

    [[nodiscard]] int size() const { return end - begin; }
  };
  [[nodiscard]] BandRows rows_of(Band& band) const;
  void order(const std::vector<std::vector<int>>& neighbours);
  void reserve(Band& band, int num_border);
  void fill(Band& band, const float* blocks, const float* inertia);
  void load(Band& band, std::span<const Summand> right) const;
  void unload(const Band& band, float* solution) const;

  static constexpr int kHalves = 2;
  std::array<Band, kHalves + 1> bands_;  ///< the last one is the border
  std::vector<int> places_;              ///< of each unknown in the order
  std::vector<int> unknowns_;            ///< in the order
  std::vector<std::pair<int, int>> pairs_;
  std::vector<int> first_pairs_;            ///< of each unknown as the lower one
  std::vector<std::vector<int>> pairs_of_;  ///< of each unknown
  int num_border_ = 0;                      ///< numbers, filled up
};

}  // namespace weft::fast
