#pragma once

#include <array>
#include <utility>

#include <weft/core/types.hpp>
#include <weft/custom_forces/assembly/element_chunks.hpp>
#include <weft/custom_forces/assembly/parallel_sum.hpp>

namespace weft::forces {

/// Sums what elements (edges, hinges, triangles) give to their nodes, in parallel and always in the
/// same order: parallel_sum() says how.
template <int kNodes>
class ElementAssembly {
 public:
  using Elements =
      Eigen::Matrix<int, kNodes, Eigen::Dynamic>;  ///< node indices, one column per element

  /// elements must be in [0, num_nodes). grain: elements per chunk, > 0.
  ElementAssembly(Elements elements, int num_nodes, int grain = kDefaultGrain)
      : elements_(std::move(elements)), chunks_(elements_, num_nodes, grain) {}

  [[nodiscard]] const Elements& elements() const { return elements_; }
  [[nodiscard]] int num_nodes() const { return chunks_.num_nodes(); }
  [[nodiscard]] Eigen::Index scratch_columns() const { return chunks_.num_slots(); }

  /// result += sum over elements. kernel(e, parts) writes the contribution of element e to its
  /// nodes. scratch: 3 x at least scratch_columns(), contents do not matter. result: 3 x
  /// num_nodes(). Throws InvalidArgument for other sizes, as for the state of another mesh.
  template <class Scalar, class Kernel>
  void add(const Kernel& kernel, Matrix3XRef<Scalar> scratch, Matrix3XRef<Scalar> result) const;

  /// Elements per chunk: about 10 us of hinges, large against the cost of a task (about 1 us).
  static constexpr int kDefaultGrain = 2048;

 private:
  Elements elements_;
  ElementChunks chunks_;
};

template <int kNodes>
template <class Scalar, class Kernel>
void ElementAssembly<kNodes>::add(const Kernel& kernel, Matrix3XRef<Scalar> scratch,
                                  Matrix3XRef<Scalar> result) const {
  check_sum_sizes(num_nodes(), scratch_columns(), result.cols(), scratch.cols());
  const auto accumulate = [&](const ElementChunks::Chunk& chunk, const auto& sum_of_slot) {
    scratch.middleCols(chunk.first_slot, chunk.num_slots()).setZero();
    std::array<Vector3<Scalar>, kNodes> parts;
    for (Eigen::Index place = chunk.begin; place < chunk.end; ++place) {
      kernel(Eigen::Index{chunks_.order()[static_cast<std::size_t>(place)]}, parts);
      for (int corner = 0; corner < kNodes; ++corner) {
        scratch.col(chunks_.slots()(corner, place)) += parts[static_cast<std::size_t>(corner)];
      }
    }
    for (Eigen::Index slot = chunk.first_slot; slot < chunk.last_slot; ++slot) {
      sum_of_slot(slot, Vector3<Scalar>(scratch.col(slot)));
    }
  };
  parallel_sum<Scalar>(chunks_, accumulate, scratch, result);
}

}  // namespace weft::forces
