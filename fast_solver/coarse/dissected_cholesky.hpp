#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include <weft/fast_solver/coarse/coarse_kernel.hpp>
#include <weft/fast_solver/simd/aligned_matrix.hpp>
#include <weft/fast_solver/threads/worker_team.hpp>

namespace weft::fast {

/// Cholesky factor of a symmetric matrix of 3 x 3 blocks by one level of nested dissection (George 1973), in single precision.
/// A separator splits the unknowns into two subdomains, which are factorized in parallel. Each subdomain is a band in
/// Cuthill and McKee's order (1969) and contributes a Schur complement to the separator's dense block. The structure is
/// analyzed once because the matrix is factorized again in every few iterations.
/// Threads  one object from one thread at a time, and on a team. Only the constructor allocates memory.
class DissectedCholesky {
 public:
  DissectedCholesky() = default;
  /// pairs: unknowns between which there are blocks, the lower one first, ascending.
  DissectedCholesky(int num_unknowns, const std::vector<std::pair<int, int>>& pairs);

  [[nodiscard]] int size() const { return static_cast<int>(positions_.size()); }
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
  void factorize(const float* blocks, const float* inertia, WorkerTeam& team);
  /// Part of a right-hand side: four numbers, the last of which is not used, of each of the unknowns begin ... end - 1.
  struct Summand {
    const float* numbers;
    int begin;
    int end;
  };
  /// solution = A^-1 (sum of right), four numbers of each unknown.
  void solve(std::span<const Summand> right, float* solution, WorkerTeam& team);

 private:
  /// Unknowns begin ... end - 1 of the elimination order: a subdomain, or the separator itself.
  struct Subdomain {
    int begin = 0;
    int end = 0;
    int width = 1;
    int lowest = 0;  ///< unknowns: lowest ... highest - 1, and others between them
    int highest = 0;
    AlignedVector<float> values;
    AlignedVector<float> diagonal;
    AlignedVector<float> vector;
    AlignedVector<float> schur_complement;
    AlignedVector<float> separator;
    std::vector<int> pairs;  ///< pairs whose blocks it contains

    [[nodiscard]] int size() const { return end - begin; }
  };
  [[nodiscard]] FactorRows rows_of(Subdomain& subdomain) const;
  void order(const std::vector<std::vector<int>>& neighbors);
  void reserve(Subdomain& subdomain, int num_separator);
  void fill(Subdomain& subdomain, const float* blocks, const float* inertia);
  void gather(Subdomain& subdomain, std::span<const Summand> right) const;
  void scatter(const Subdomain& subdomain, float* solution) const;

  static constexpr int kSubdomains = 2;
  std::array<Subdomain, kSubdomains + 1> subdomains_;  ///< the last one is the separator
  std::vector<int> positions_;                         ///< for each unknown in the order
  std::vector<int> unknowns_;                          ///< in the order
  std::vector<std::pair<int, int>> pairs_;
  std::vector<int> first_pairs_;            ///< for each unknown as the lower one
  std::vector<std::vector<int>> pairs_of_;  ///< for each unknown
  int num_separator_ = 0;                   ///< numbers, padded
};

}  // namespace weft::fast
