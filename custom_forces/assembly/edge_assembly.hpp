#pragma once

#include <cstddef>
#include <type_traits>
#include <utility>
#include <vector>

#include <weft/core/types.hpp>
#include <weft/custom_forces/assembly/edge_kernel.hpp>
#include <weft/custom_forces/assembly/element_chunks.hpp>
#include <weft/custom_forces/assembly/parallel_sum.hpp>

namespace weft::forces {

/// Sums what edges give to their two nodes: ElementAssembly<2> for pairs of opposite forces that
/// depend on differences along the edge, made for the processor's vector unit.
///
/// Each chunk copies the vectors of its nodes into arrays of one component each and sums into such
/// arrays too. Its edges are ordered by the distance between their node numbers, like the diagonals
/// of a matrix: on a grid that makes long runs whose first nodes, and second nodes, follow each
/// other, so that whole vectors are loaded and stored. Edges outside of runs are computed in
/// batches as well, with their differences fetched and their forces added one by one.
class EdgeAssembly {
 public:
  /// edges: node indices in [0, num_nodes), first and second. grain: edges per chunk, > 0.
  EdgeAssembly(Edges edges, int num_nodes, int grain = kDefaultGrain);

  [[nodiscard]] const Edges& edges() const { return edges_; }
  [[nodiscard]] int num_nodes() const { return chunks_.num_nodes(); }
  /// The edge at each place in the order of evaluation.
  [[nodiscard]] const std::vector<int>& order() const { return chunks_.order(); }
  /// Columns of scratch for add_pairs() with so many fields.
  [[nodiscard]] Eigen::Index scratch_columns(int num_fields) const {
    return chunks_.num_slots() * (2 + num_fields);
  }

  /// result += sum over edges. force(place, differences...) is what the first node of the edge at
  /// this place gets [N], its second node gets the opposite; differences, one for each field, are
  /// field(second) - field(first). fields: 3 x num_nodes() each. scratch: 3 x at least
  /// scratch_columns(number of fields), without gaps between columns, contents do not matter.
  /// Throws InvalidArgument for other sizes.
  template <class Scalar, class Force, class... Fields>
  void add_pairs(const Force& force, Matrix3XRef<Scalar> scratch, Matrix3XRef<Scalar> result,
                 const Fields&... fields) const;

  /// Edges per chunk: 8 chunks for the 28518 springs of the classic cloth, some 5 us each. Smaller
  /// chunks have more nodes in common, larger ones leave threads without work (bench/results).
  static constexpr int kDefaultGrain = 4096;

 private:
  /// Memory on the stack: the same cache lines for every chunk of a thread, where scratch memory would be
  /// walked through from end to end.
  static constexpr Eigen::Index kStackBytes = 128 * 1024;

  Edges edges_;
  ElementChunks chunks_;
  std::vector<int> first_slots_;   ///< of each place, counted from the chunk's first slot
  std::vector<int> second_slots_;  ///< likewise
  std::vector<EdgeRun> runs_;
  std::vector<std::size_t> first_run_;  ///< chunk c has runs_[first_run_[c] ... first_run_[c + 1])
};

template <class Scalar, class Force, class... Fields>
void EdgeAssembly::add_pairs(const Force& force, Matrix3XRef<Scalar> scratch,
                             Matrix3XRef<Scalar> result, const Fields&... fields) const {
  constexpr int kNumFields = sizeof...(Fields);
  check_sum_sizes(num_nodes(), scratch_columns(kNumFields), result.cols(), scratch.cols());
  check_sum_strides(scratch.outerStride());
  const auto accumulate = [&](const ElementChunks::Chunk& chunk, const auto& sum_of_slot) {
    const Eigen::Index num_slots = chunk.num_slots();
    // A large chunk of a wide mesh, or another kind of number, works in the scratch memory.
    alignas(64) std::byte stack[kStackBytes];
    const bool fits =
        std::is_floating_point_v<Scalar> &&
        3 * (1 + kNumFields) * num_slots * static_cast<Eigen::Index>(sizeof(Scalar)) <= kStackBytes;
    Scalar* const sums =
        fits ? reinterpret_cast<Scalar*>(stack)
             : scratch.data() + 3 * (chunks_.num_slots() + (1 + kNumFields) * chunk.first_slot);
    Scalar* place = sums;
    for (Eigen::Index i = 0; i < 3 * num_slots; ++i) *place++ = Scalar(0);
    const auto gather = [&](const auto& field) {
      for (Eigen::Index s = 0; s < num_slots; ++s) {
        const int node = chunks_.node(chunk.first_slot + s);
        for (int axis = 0; axis < 3; ++axis) place[axis * num_slots + s] = field(axis, node);
      }
      place += 3 * num_slots;
    };
    (gather(fields), ...);
    const auto c = static_cast<std::size_t>(&chunk - chunks_.chunks().data());
    evaluate_runs<Scalar, kNumFields>(
        force,
        EdgeRunsView{runs_.data() + first_run_[c], runs_.data() + first_run_[c + 1],
                     first_slots_.data(), second_slots_.data(), num_slots},
        sums);
    for (Eigen::Index s = 0; s < num_slots; ++s) {
      sum_of_slot(chunk.first_slot + s,
                  Vector3<Scalar>(sums[s], sums[num_slots + s], sums[2 * num_slots + s]));
    }
  };
  parallel_sum<Scalar>(chunks_, accumulate, scratch, result);
}

}  // namespace weft::forces
