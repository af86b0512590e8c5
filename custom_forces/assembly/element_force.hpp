#pragma once

// Tested by tests/custom_forces/law_set_test.cpp, tests/contract/law_contract_test.cpp.

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include <weft/core/tangent.hpp>
#include <weft/custom_forces/assembly/element_assembly.hpp>
#include <weft/custom_forces/assembly/element_pairs.hpp>
#include <weft/custom_forces/force_law.hpp>

namespace weft::forces {

/// What a law sees of one element of kNodes nodes; Number is the law's scalar or its Tangent.
template <class Number, int kNodes>
struct ElementState {
  std::array<Vector3<Number>, kNodes> x;  ///< positions [m]
  std::array<Vector3<Number>, kNodes> v;  ///< velocities [m/s]
};
template <class Number, int kNodes>
using ElementForces = std::array<Vector3<Number>, kNodes>;  ///< [N]

/// Sums the forces of elements, and from the same formula the products with their derivatives.
///
/// A kernel is `template <class Number> void operator()(Eigen::Index e, const ElementState<Number,
/// kNodes>&, ElementForces<Number, kNodes>&) const`; the forces come in as zero.
template <class Scalar, int kNodes>
class ElementForce {
 public:
  using Elements = typename ElementAssembly<kNodes>::Elements;

  /// elements: kNodes x m node indices in [0, num_nodes). work: rough cost of an element in springs
  /// (> 0), so that chunks take about the same time for every law.
  ElementForce(Elements elements, int num_nodes, int work = 1)
      : assembly_(std::move(elements), num_nodes,
                  std::max(1, ElementAssembly<kNodes>::kDefaultGrain / work)) {}

  [[nodiscard]] const Elements& elements() const { return assembly_.elements(); }
  [[nodiscard]] Eigen::Index size() const { return assembly_.elements().cols(); }
  [[nodiscard]] int num_nodes() const { return assembly_.num_nodes(); }
  [[nodiscard]] Eigen::Index scratch_columns() const { return assembly_.scratch_columns(); }

  /// The element as it is now.
  [[nodiscard]] ElementState<Scalar, kNodes> at(const State<Scalar>& state, Eigen::Index e) const {
    ElementState<Scalar, kNodes> element;
    for (std::size_t corner = 0; corner < kNodes; ++corner) {
      const int node = elements()(static_cast<Eigen::Index>(corner), e);
      element.x[corner] = state.positions.col(node);
      element.v[corner] = state.velocities.col(node);
    }
    return element;
  }

  template <class Kernel>
  void add_forces(const State<Scalar>& state, const Kernel& kernel, Matrix3XRef<Scalar> scratch,
                  Matrix3XRef<Scalar> forces) const {
    const auto one = [&](Eigen::Index e, ElementForces<Scalar, kNodes>& parts) {
      parts.fill(Vector3<Scalar>::Constant(Scalar(0)));
      kernel(e, at(state, e), parts);
    };
    assembly_.template add<Scalar>(one, scratch, forces);
  }

  /// product += (df/dx) changes.
  template <class Kernel>
  void add_stiffness_product(const State<Scalar>& state, const Kernel& kernel,
                             ConstMatrix3XRef<Scalar> changes, Matrix3XRef<Scalar> scratch,
                             Matrix3XRef<Scalar> product) const {
    add_product<Argument::kPositions>(state, kernel, changes, scratch, product);
  }

  /// product += (df/dv) changes.
  template <class Kernel>
  void add_damping_product(const State<Scalar>& state, const Kernel& kernel,
                           ConstMatrix3XRef<Scalar> changes, Matrix3XRef<Scalar> scratch,
                           Matrix3XRef<Scalar> product) const {
    add_product<Argument::kVelocities>(state, kernel, changes, scratch, product);
  }

  /// Appends each pair of corners of element e, tied by stiffness(corner, other) [N/m].
  template <class Stiffness>
  void add_pairs(Eigen::Index e, const Stiffness& stiffness,
                 std::vector<PairStiffness<Scalar>>& pairs) const {
    append_pairs(elements(), e, stiffness, pairs);
  }

  /// Sum of value(e, element), in the order of the elements.
  template <class Value>
  [[nodiscard]] Scalar sum(const State<Scalar>& state, const Value& value) const {
    Scalar total(0);
    for (Eigen::Index e = 0; e < size(); ++e) total += value(e, at(state, e));
    return total;
  }

 private:
  enum class Argument { kPositions, kVelocities };

  template <Argument kArgument, class Kernel>
  void add_product(const State<Scalar>& state, const Kernel& kernel,
                   ConstMatrix3XRef<Scalar> changes, Matrix3XRef<Scalar> scratch,
                   Matrix3XRef<Scalar> product) const {
    using Number = Tangent<Scalar>;
    const auto one = [&](Eigen::Index e, ElementForces<Scalar, kNodes>& parts) {
      const ElementState<Scalar, kNodes> now = at(state, e);
      ElementState<Number, kNodes> moving;
      ElementForces<Number, kNodes> forces;
      for (std::size_t corner = 0; corner < kNodes; ++corner) {
        const int node = elements()(static_cast<Eigen::Index>(corner), e);
        for (int axis = 0; axis < 3; ++axis) {
          const Scalar change = changes(axis, node);
          const Scalar none(0);
          const bool is_position = kArgument == Argument::kPositions;
          moving.x[corner][axis] = Number(now.x[corner][axis], is_position ? change : none);
          moving.v[corner][axis] = Number(now.v[corner][axis], is_position ? none : change);
          forces[corner][axis] = Number(none);
        }
      }
      kernel(e, moving, forces);
      for (std::size_t corner = 0; corner < kNodes; ++corner) {
        for (int axis = 0; axis < 3; ++axis) parts[corner][axis] = forces[corner][axis].rate;
      }
    };
    assembly_.template add<Scalar>(one, scratch, product);
  }

  ElementAssembly<kNodes> assembly_;
};

}  // namespace weft::forces
