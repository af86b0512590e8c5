#pragma once

// Tested by tests/custom_forces/assembly/edge_assembly_test.cpp, tests/custom_forces/assembly/batched_assembly_test.cpp.

#include <array>
#include <cstddef>
#include <type_traits>
#include <vector>

#include <weft/core/types.hpp>
#include <weft/custom_forces/assembly/element_chunks.hpp>
#include <weft/custom_forces/assembly/parallel_sum.hpp>

namespace weft::forces {

/// Elements computed at a time: enough to fill vectors of any width, few enough for the first-level
/// cache.
inline constexpr int kElementBatch = 64;

/// Elements at successive places.
struct ElementRun {
  int begin;            ///< first place
  int count;            ///< <= kElementBatch
  bool is_consecutive;  ///< from each element to the next, all slots go up by one
};

/// The runs of one chunk.
template <int kNodes>
struct ElementRunsView {
  const ElementRun* begin;
  const ElementRun* end;
  std::array<const int*, kNodes> slots;  ///< of each corner, by place
  Eigen::Index num_slots;
};

/// Elements (edges, triples, hinges) in the order in which a vector unit computes them.
///
/// The elements of each chunk are ordered by the distances between their node numbers, like the
/// diagonals of a matrix: on a grid that makes long runs whose nodes, corner by corner, follow each
/// other, so that whole vectors are loaded and stored. Elements outside of runs are computed in
/// batches as well, with their nodes fetched and their forces added one by one.
template <int kNodes>
class ElementRuns {
 public:
  /// Node indices, one column per element.
  using Elements = Eigen::Matrix<int, kNodes, Eigen::Dynamic>;

  /// elements: node indices in [0, num_nodes). grain: elements per chunk, > 0.
  ElementRuns(Elements elements, int num_nodes, int grain);

  [[nodiscard]] const Elements& elements() const { return elements_; }
  [[nodiscard]] int num_nodes() const { return chunks_.num_nodes(); }
  /// The element at each place in the order of evaluation.
  [[nodiscard]] const std::vector<int>& order() const { return chunks_.order(); }
  /// Columns of scratch for add() with so many fields.
  [[nodiscard]] Eigen::Index scratch_columns(int num_fields) const {
    return chunks_.num_slots() * (2 + num_fields);
  }

  /// result += sum over elements, the same bits for any number of threads. evaluate(view, work) adds
  /// the forces of one chunk to work, which holds the sums and then the fields, each as 3 arrays of
  /// view.num_slots numbers. fields: 3 x num_nodes() each. scratch: 3 x at least scratch_columns(number
  /// of fields), without gaps between columns, contents do not matter. Throws InvalidArgument for
  /// other sizes.
  template <class Scalar, class Evaluate, class... Fields>
  void add(const Evaluate& evaluate, Matrix3XRef<Scalar> scratch, Matrix3XRef<Scalar> result,
           const Fields&... fields) const;

  /// Calls read(view, field) for each chunk in turn, field as 3 arrays of view.num_slots numbers.
  template <class Scalar, class Read>
  void for_each_chunk(const Read& read, ConstMatrix3XRef<Scalar> field) const;

 private:
  /// Memory on the stack: the same cache lines for every chunk of a thread, where scratch memory would be
  /// walked through from end to end.
  static constexpr Eigen::Index kStackBytes = 128 * 1024;

  void append_runs(int begin, int end);
  [[nodiscard]] ElementRunsView<kNodes> view(const ElementChunks::Chunk& chunk) const;
  /// Copies the field of the chunk's nodes to place, as 3 arrays of chunk.num_slots() numbers.
  template <class Scalar, class Field>
  void gather(const ElementChunks::Chunk& chunk, const Field& field, Scalar* place) const;

  Elements elements_;
  ElementChunks chunks_;
  std::array<std::vector<int>, kNodes>
      slots_;  ///< of each place, counted from the chunk's first slot
  std::vector<ElementRun> runs_;
  std::vector<std::size_t> first_run_;  ///< chunk c has runs_[first_run_[c] ... first_run_[c + 1])
};

template <int kNodes>
template <class Scalar, class Field>
void ElementRuns<kNodes>::gather(const ElementChunks::Chunk& chunk, const Field& field,
                                 Scalar* place) const {
  const Eigen::Index num_slots = chunk.num_slots();
  for (Eigen::Index s = 0; s < num_slots; ++s) {
    const int node = chunks_.node(chunk.first_slot + s);
    for (int axis = 0; axis < 3; ++axis) place[axis * num_slots + s] = field(axis, node);
  }
}

template <int kNodes>
template <class Scalar, class Evaluate, class... Fields>
void ElementRuns<kNodes>::add(const Evaluate& evaluate, Matrix3XRef<Scalar> scratch,
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
    ((gather(chunk, fields, place), place += 3 * num_slots), ...);
    evaluate(view(chunk), sums);
    for (Eigen::Index s = 0; s < num_slots; ++s) {
      sum_of_slot(chunk.first_slot + s,
                  Vector3<Scalar>(sums[s], sums[num_slots + s], sums[2 * num_slots + s]));
    }
  };
  parallel_sum<Scalar>(chunks_, accumulate, scratch, result);
}

template <int kNodes>
template <class Scalar, class Read>
void ElementRuns<kNodes>::for_each_chunk(const Read& read, ConstMatrix3XRef<Scalar> field) const {
  std::vector<Scalar> more;
  for (const ElementChunks::Chunk& chunk : chunks_.chunks()) {
    alignas(64) std::byte stack[kStackBytes];
    const auto count = static_cast<std::size_t>(3 * chunk.num_slots());
    const bool fits = std::is_floating_point_v<Scalar> && count * sizeof(Scalar) <= kStackBytes;
    if (!fits) more.resize(count, Scalar(0));
    Scalar* const values = fits ? reinterpret_cast<Scalar*>(stack) : more.data();
    gather(chunk, field, values);
    read(view(chunk), static_cast<const Scalar*>(values));
  }
}

extern template class ElementRuns<2>;
extern template class ElementRuns<3>;
extern template class ElementRuns<4>;

}  // namespace weft::forces
