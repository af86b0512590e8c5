#pragma once

// Tested by tests/custom_forces/assembly/edge_assembly_test.cpp, tests/custom_forces/assembly/element_assembly_test.cpp.

#include <string>

#include <weft/core/error.hpp>
#include <weft/core/parallel/parallel_for.hpp>
#include <weft/core/trace.hpp>
#include <weft/core/types.hpp>
#include <weft/custom_forces/assembly/element_chunks.hpp>

namespace weft::forces {

/// Shared nodes per task when the chunks are joined, and the number above which the join is worth
/// tasks at all: below, it takes less time than to wake a thread (about 2 us). Each node is summed
/// by one thread, so this changes no bit.
inline constexpr std::size_t kJoinGrain = 2048;

/// result += sum over the chunks, in parallel and always in the same order.
///
/// This is Werth's parallel_reduce over the connections: the elements are cut into chunks of a
/// grain size, each chunk accumulates forces of its own, the chunks' forces are added up at the
/// end. Two things differ. A chunk's accumulator holds only the nodes that the chunk touches, not a
/// whole body; and chunks depend on the grain only, never on the number of threads, and are joined
/// in a fixed order, so that the sum has the same bits for any number of threads.
///
/// accumulate(chunk, sum_of_slot) computes a chunk and calls sum_of_slot(slot, vector) once for
/// each of its slots. slot_sums: 3 x at least num_slots(), contents do not matter.
template <class Scalar, class Accumulate>
void parallel_sum(const ElementChunks& chunks, const Accumulate& accumulate,
                  Matrix3XRef<Scalar> slot_sums, Matrix3XRef<Scalar> result) {
  const auto sum_of_slot = [&](Eigen::Index slot, const Vector3<Scalar>& sum) {
    if (chunks.is_shared(slot)) {
      slot_sums.col(slot) = sum;
    } else {
      result.col(chunks.node(slot)) += sum;
    }
  };
  const auto join = [&](IndexRange range) {
    const TraceScope trace("join");
    const int* const slots = chunks.shared_slots().data();
    for (std::size_t i = range.begin; i < range.end; ++i) {
      const ElementChunks::SharedNode& shared = chunks.shared_nodes()[i];
      Vector3<Scalar> sum = result.col(shared.node);
      for (int s = shared.first_slot; s < shared.last_slot; ++s) {
        sum += slot_sums.col(slots[s]);
      }
      result.col(shared.node) = sum;
    }
  };
  parallel_for(chunks.chunks().size(), [&](std::size_t c) {
    const TraceScope trace("chunk");
    accumulate(chunks.chunks()[c], sum_of_slot);
  });
  parallel_for(IndexRange{0, chunks.shared_nodes().size()}, kJoinGrain, join);
}

/// Throws InvalidArgument for sizes that do not fit, as for the state of another mesh.
inline void check_sum_sizes(int num_nodes, Eigen::Index scratch_columns, Eigen::Index given_result,
                            Eigen::Index given_scratch) {
  if (given_result == num_nodes && given_scratch >= scratch_columns) return;
  throw InvalidArgument("element assembly: result 3 x " + std::to_string(given_result) +
                        ", scratch 3 x " + std::to_string(given_scratch) + ", expected 3 x " +
                        std::to_string(num_nodes) + " and at least 3 x " +
                        std::to_string(scratch_columns));
}

/// Throws InvalidArgument for scratch memory with gaps between its columns.
inline void check_sum_strides(Eigen::Index scratch_stride) {
  if (scratch_stride == 3) return;
  throw InvalidArgument("element assembly: scratch with an outer stride of " +
                        std::to_string(scratch_stride) + ", expected 3");
}

}  // namespace weft::forces
