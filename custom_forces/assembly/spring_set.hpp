#pragma once

// Tested by tests/custom_forces/laws/elastic/tension_test.cpp.

#include <cmath>

#include <weft/custom_forces/assembly/edge_assembly.hpp>
#include <weft/custom_forces/force_law.hpp>
#include <weft/custom_forces/law_input.hpp>

namespace weft::forces {

/// Shortest spring whose direction is still trusted, as a fraction of its rest length [-]. At 1e-6
/// the direction of a double-precision spring has a relative error of about 2e-10, far below every
/// validated tolerance; a shorter spring exerts no force, for a direction made of rounding errors
/// would be noise.
inline constexpr double kMinLengthRatio = 1e-6;

/// One edge as it is now.
template <class Scalar>
struct Spring {
  Scalar rest_length;             ///< [m]
  Scalar length;                  ///< [m]; 0 if the edge is too short
  Scalar inverse_length;          ///< [1/m]; 0 if the edge is too short
  PlainVector<Scalar> direction;  ///< unit vector from i to j; zero if the edge is too short
  [[nodiscard]] Scalar extension() const { return length - rest_length; }  ///< [m]
};

/// The edges of a law with their rest lengths: what all laws along edges share.
template <class Scalar>
class SpringSet {
 public:
  /// Throws InvalidArgument for edge sets that the mesh does not have and for an edge without
  /// length.
  SpringSet(const LawSpecification& specification, const ClothMesh& mesh)
      : assembly_(law_edges(specification, mesh), mesh.num_nodes()),
        rest_lengths_(
            law_rest_lengths(specification, mesh, assembly_.edges()).template cast<Scalar>()),
        ordered_rest_lengths_(rest_lengths_.size()) {
    for (Eigen::Index place = 0; place < rest_lengths_.size(); ++place) {
      ordered_rest_lengths_[place] =
          rest_lengths_[assembly_.order()[static_cast<std::size_t>(place)]];
    }
  }

  [[nodiscard]] Eigen::Index scratch_columns() const {
    return assembly_.scratch_columns(1 + kMaxFields);
  }

  /// result += force(spring, changes...) on node i of every spring and its opposite on node j [N].
  /// changes: for each of the fields (velocities, displacements; at most kMaxFields) the difference
  /// field(j) - field(i). The function must have no branches that a vector unit cannot take.
  template <class Force, class... Fields>
  void add_pairs(const State<Scalar>& state, const Force& force, Matrix3XRef<Scalar> scratch,
                 Matrix3XRef<Scalar> result, const Fields&... fields) const {
    static_assert(sizeof...(Fields) <= kMaxFields);
    const Scalar* const rest_lengths = ordered_rest_lengths_.data();
    const auto force_at = [&force, rest_lengths](Eigen::Index place,
                                                 const PlainVector<Scalar>& difference,
                                                 const auto&... changes) -> PlainVector<Scalar> {
      return force(spring(rest_lengths[place], difference), changes...);
    };
    assembly_.template add_pairs<Scalar>(force_at, scratch, result, state.positions, fields...);
  }

  /// Sum of value(spring, changes...), in the order of the edges.
  template <class Value, class... Fields>
  [[nodiscard]] Scalar sum(const State<Scalar>& state, const Value& value,
                           const Fields&... fields) const {
    Scalar total(0);
    for (Eigen::Index e = 0; e < rest_lengths_.size(); ++e) {
      const int i = assembly_.edges()(0, e);
      const int j = assembly_.edges()(1, e);
      const auto difference = [&](const auto& field) -> PlainVector<Scalar> {
        return {Scalar(field(0, j) - field(0, i)), Scalar(field(1, j) - field(1, i)),
                Scalar(field(2, j) - field(2, i))};
      };
      total += value(spring(rest_lengths_[e], difference(state.positions)), difference(fields)...);
    }
    return total;
  }

 private:
  static constexpr int kMaxFields = 2;

  [[nodiscard]] static Spring<Scalar> spring(Scalar rest_length,
                                             const PlainVector<Scalar>& difference) {
    using std::sqrt;
    const Scalar squared_length = difference.squared_norm();
    const Scalar shortest = Scalar(kMinLengthRatio) * rest_length;
    const bool has_direction = squared_length > shortest * shortest;  // false for NaN
    const Scalar root = sqrt(has_direction ? squared_length : Scalar(1));
    const Scalar one_or_zero = has_direction ? Scalar(1) : Scalar(0);
    const Scalar inverse_length = Scalar(one_or_zero / root);
    return {rest_length, Scalar(one_or_zero * root), inverse_length, inverse_length * difference};
  }

  EdgeAssembly assembly_;
  VectorX<Scalar> rest_lengths_;          ///< [m] of each edge
  VectorX<Scalar> ordered_rest_lengths_;  ///< [m] of the edge at each place of the assembly
};

}  // namespace weft::forces
