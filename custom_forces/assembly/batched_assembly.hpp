#pragma once

#include <cstddef>
#include <type_traits>
#include <utility>
#include <vector>

#include <weft/core/tangent.hpp>
#include <weft/core/types.hpp>
#include <weft/custom_forces/assembly/batched_kernel.hpp>
#include <weft/custom_forces/assembly/element_runs.hpp>

namespace weft::forces {

/// Sums what elements give to their nodes: ElementAssembly for formulas without branches, made for the
/// processor's vector unit. Elements are computed in the order of ElementRuns.
template <int kNodes>
class BatchedAssembly {
 public:
  using Elements = typename ElementRuns<kNodes>::Elements;

  /// elements: kNodes x m node indices in [0, num_nodes). grain: elements per chunk, > 0.
  BatchedAssembly(Elements elements, int num_nodes, int grain = kDefaultGrain)
      : runs_(std::move(elements), num_nodes, grain) {}

  [[nodiscard]] const Elements& elements() const { return runs_.elements(); }
  [[nodiscard]] Eigen::Index size() const { return runs_.elements().cols(); }
  [[nodiscard]] int num_nodes() const { return runs_.num_nodes(); }
  /// The element at each place in the order of evaluation.
  [[nodiscard]] const std::vector<int>& order() const { return runs_.order(); }
  /// Columns of scratch for add() with so many fields.
  [[nodiscard]] Eigen::Index scratch_columns(int num_fields) const {
    return runs_.scratch_columns(num_fields);
  }

  /// result += sum over elements. force(place, corners...) is what the nodes of the element at this
  /// place get [N], as Corners; corners, one for each field, are the field at its nodes. fields: 3 x
  /// num_nodes() each. scratch: 3 x at least scratch_columns(number of fields), without gaps between
  /// columns, contents do not matter. Throws InvalidArgument for other sizes.
  template <class Scalar, class Force, class... Fields>
  void add(const Force& force, Matrix3XRef<Scalar> scratch, Matrix3XRef<Scalar> result,
           const Fields&... fields) const {
    const auto evaluate = [&](const ElementRunsView<kNodes>& runs, Scalar* work) {
      evaluate_elements<Scalar, kNodes, sizeof...(Fields)>(force, runs, work);
    };
    runs_.template add<Scalar>(evaluate, scratch, result, fields...);
  }

  /// product += (df/dx) changes, for force(place, corners) as a template over the number, which is a Tangent here. positions,
  /// changes: 3 x num_nodes(). scratch: for two fields.
  template <class Scalar, class Force>
  void add_stiffness_product(const Force& force, ConstMatrix3XRef<Scalar> positions,
                             ConstMatrix3XRef<Scalar> changes, Matrix3XRef<Scalar> scratch,
                             Matrix3XRef<Scalar> product) const {
    using Number = Tangent<Scalar>;
    const auto force_change = [&force](Eigen::Index place, const Corners<Scalar, kNodes>& x,
                                       const Corners<Scalar, kNodes>& by) {
      Corners<Number, kNodes> moving;
      for (std::size_t corner = 0; corner < kNodes; ++corner) {
        moving[corner] = {Number(x[corner].x, by[corner].x), Number(x[corner].y, by[corner].y),
                          Number(x[corner].z, by[corner].z)};
      }
      const Corners<Number, kNodes> forces = force(place, moving);
      Corners<Scalar, kNodes> rates;
      for (std::size_t corner = 0; corner < kNodes; ++corner) {
        rates[corner] = {forces[corner].x.rate, forces[corner].y.rate, forces[corner].z.rate};
      }
      return rates;
    };
    add<Scalar>(force_change, scratch, product, positions, changes);
  }

  /// Element e as corners of the field.
  template <class Scalar>
  [[nodiscard]] Corners<Scalar, kNodes> at(ConstMatrix3XRef<Scalar> field, Eigen::Index e) const {
    Corners<Scalar, kNodes> corners;
    for (std::size_t corner = 0; corner < kNodes; ++corner) {
      const int node = elements()(static_cast<Eigen::Index>(corner), e);
      corners[corner] = {field(0, node), field(1, node), field(2, node)};
    }
    return corners;
  }

  /// Sum over elements of value(place, corners), in one order; of single-precision numbers in double
  /// precision. field: 3 x num_nodes().
  template <class Scalar, class Value>
  [[nodiscard]] Scalar sum(const Value& value, ConstMatrix3XRef<Scalar> field) const {
    using Sum = std::conditional_t<std::is_same_v<Scalar, float>, double, Scalar>;
    PartialSums<Sum> sums;
    for (Sum& partial : sums) partial = Sum(0);
    runs_.template for_each_chunk<Scalar>(
        [&](const ElementRunsView<kNodes>& runs, const Scalar* corners) {
          sum_elements<Scalar, kNodes, Sum>(value, runs, corners, sums);
        },
        field);
    Sum total(0);
    for (const Sum& partial : sums) total += partial;
    return Scalar(total);
  }

  /// Elements per chunk: some 15 us of hinges (30 us in double precision), large against the cost of a task (about 1 us).
  static constexpr int kDefaultGrain = 2048;

 private:
  ElementRuns<kNodes> runs_;
};

}  // namespace weft::forces
