#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <vector>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <weft/custom_forces/core/error.hpp>
#include <weft/custom_forces/core/types.hpp>

namespace weft::forces {

/// Sums what elements (edges, hinges, triangles) give to their nodes, in parallel and always in the
/// same order.
///
/// This is Werth's parallel_reduce over the connections: the elements are cut into chunks of a
/// grain size, each chunk accumulates forces of its own, the chunks' forces are added up at the
/// end. Two things differ. A chunk's accumulator holds only the nodes that the chunk touches, not a
/// whole body; and chunks depend on the grain only, never on the number of threads, and are joined
/// in a fixed order, so that the sum has the same bits for any number of threads.
template <int kNodes>
class ElementAssembly {
 public:
  using Elements =
      Eigen::Matrix<int, kNodes, Eigen::Dynamic>;  ///< node indices, one column per element

  /// elements must be in [0, num_nodes). grain: elements per chunk, > 0.
  ElementAssembly(Elements elements, int num_nodes, int grain = kDefaultGrain);

  [[nodiscard]] const Elements& elements() const { return elements_; }
  [[nodiscard]] int num_nodes() const { return static_cast<int>(first_slot_.size()) - 1; }
  [[nodiscard]] Eigen::Index scratch_columns() const { return num_slots_; }

  /// result += sum over elements. kernel(e, parts) writes the contribution of element e to its
  /// nodes. scratch: 3 x at least scratch_columns(), contents do not matter. result: 3 x
  /// num_nodes(). Throws InvalidArgument for other sizes, as for the state of another mesh.
  template <class Scalar, class Kernel>
  void add(const Kernel& kernel, Matrix3XRef<Scalar> scratch, Matrix3XRef<Scalar> result) const;

  /// About 20 us of springs: large against the cost of a task (about 1 us), small enough to feed
  /// four threads with the 28518 springs of the classic cloth.
  static constexpr int kDefaultGrain = 2048;

 private:
  struct Chunk {
    Eigen::Index begin;       ///< first element
    Eigen::Index end;         ///< one past the last element
    Eigen::Index first_slot;  ///< its accumulator: columns [first_slot, last_slot) of scratch
    Eigen::Index last_slot;
  };
  /// Nodes per task when the chunks are joined; each node is summed by one thread, so this changes
  /// no bit.
  static constexpr int kNodeGrain = 1024;

  Elements elements_;
  Elements slots_;  ///< for each element and corner, its column in scratch
  std::vector<Chunk> chunks_;
  std::vector<Eigen::Index>
      first_slot_;  ///< node n gathers node_slots_[first_slot_[n] ... first_slot_[n + 1])
  std::vector<Eigen::Index> node_slots_;
  Eigen::Index num_slots_ = 0;
};

template <int kNodes>
ElementAssembly<kNodes>::ElementAssembly(Elements elements, int num_nodes, int grain)
    : elements_(std::move(elements)), slots_(kNodes, elements_.cols()) {
  std::vector<std::vector<Eigen::Index>> slots_of_node(static_cast<std::size_t>(num_nodes));
  std::vector<Eigen::Index> slot_in_chunk(static_cast<std::size_t>(num_nodes), -1);
  for (Eigen::Index begin = 0; begin < elements_.cols(); begin += grain) {
    const Eigen::Index end = std::min<Eigen::Index>(begin + grain, elements_.cols());
    const Eigen::Index chunk_first_slot = num_slots_;
    for (Eigen::Index e = begin; e < end; ++e) {
      for (int corner = 0; corner < kNodes; ++corner) {
        const auto node = static_cast<std::size_t>(elements_(corner, e));
        if (slot_in_chunk[node] < chunk_first_slot) {
          slot_in_chunk[node] = num_slots_;
          slots_of_node[node].push_back(num_slots_++);
        }
      }
    }
    for (Eigen::Index e = begin; e < end; ++e) {
      for (int corner = 0; corner < kNodes; ++corner) {
        slots_(corner, e) =
            static_cast<int>(slot_in_chunk[static_cast<std::size_t>(elements_(corner, e))]);
      }
    }
    chunks_.push_back({begin, end, chunk_first_slot, num_slots_});
  }
  first_slot_.push_back(0);
  for (const auto& slots : slots_of_node) {
    node_slots_.insert(node_slots_.end(), slots.begin(), slots.end());
    first_slot_.push_back(static_cast<Eigen::Index>(node_slots_.size()));
  }
}

template <int kNodes>
template <class Scalar, class Kernel>
void ElementAssembly<kNodes>::add(const Kernel& kernel, Matrix3XRef<Scalar> scratch,
                                  Matrix3XRef<Scalar> result) const {
  if (result.cols() != num_nodes() || scratch.cols() < num_slots_) {
    throw InvalidArgument("element assembly: result 3 x " + std::to_string(result.cols()) +
                          ", scratch 3 x " + std::to_string(scratch.cols()) + ", expected 3 x " +
                          std::to_string(num_nodes()) + " and at least 3 x " +
                          std::to_string(num_slots_));
  }
  tbb::parallel_for(std::size_t{0}, chunks_.size(), [&](std::size_t c) {
    const Chunk& chunk = chunks_[c];
    scratch.middleCols(chunk.first_slot, chunk.last_slot - chunk.first_slot).setZero();
    std::array<Vector3<Scalar>, kNodes> parts;
    for (Eigen::Index e = chunk.begin; e < chunk.end; ++e) {
      kernel(e, parts);
      for (int corner = 0; corner < kNodes; ++corner) {
        scratch.col(slots_(corner, e)) += parts[static_cast<std::size_t>(corner)];
      }
    }
  });
  tbb::parallel_for(tbb::blocked_range<int>(0, num_nodes(), kNodeGrain),
                    [&](const tbb::blocked_range<int>& nodes) {
                      for (int node = nodes.begin(); node < nodes.end(); ++node) {
                        const auto n = static_cast<std::size_t>(node);
                        for (Eigen::Index s = first_slot_[n]; s < first_slot_[n + 1]; ++s) {
                          result.col(node) += scratch.col(node_slots_[static_cast<std::size_t>(s)]);
                        }
                      }
                    });
}

}  // namespace weft::forces
