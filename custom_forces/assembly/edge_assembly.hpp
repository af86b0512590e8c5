#pragma once

#include <utility>
#include <vector>

#include <weft/core/types.hpp>
#include <weft/custom_forces/assembly/edge_kernel.hpp>
#include <weft/custom_forces/assembly/element_runs.hpp>

namespace weft::forces {

/// Sums what edges give to their two nodes: ElementAssembly<2> for pairs of opposite forces that
/// depend on differences along the edge, made for the processor's vector unit.
///
/// Each chunk copies the vectors of its nodes into arrays of one component each and sums into such
/// arrays too, its edges in the order of ElementRuns.
class EdgeAssembly {
 public:
  /// edges: node indices in [0, num_nodes), first and second. grain: edges per chunk, > 0.
  EdgeAssembly(Edges edges, int num_nodes, int grain = kDefaultGrain)
      : runs_(std::move(edges), num_nodes, grain) {}

  [[nodiscard]] const Edges& edges() const { return runs_.elements(); }
  [[nodiscard]] int num_nodes() const { return runs_.num_nodes(); }
  /// The edge at each place in the order of evaluation.
  [[nodiscard]] const std::vector<int>& order() const { return runs_.order(); }
  /// Columns of scratch for add_pairs() with so many fields.
  [[nodiscard]] Eigen::Index scratch_columns(int num_fields) const {
    return runs_.scratch_columns(num_fields);
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
  ElementRuns<2> runs_;
};

template <class Scalar, class Force, class... Fields>
void EdgeAssembly::add_pairs(const Force& force, Matrix3XRef<Scalar> scratch,
                             Matrix3XRef<Scalar> result, const Fields&... fields) const {
  const auto evaluate = [&](const ElementRunsView<2>& runs, Scalar* work) {
    evaluate_runs<Scalar, sizeof...(Fields)>(force, runs, work);
  };
  runs_.template add<Scalar>(evaluate, scratch, result, fields...);
}

}  // namespace weft::forces
