#pragma once

#include <cmath>

#include <weft/custom_forces/element_assembly.hpp>
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
  int first;                  ///< node i
  int second;                 ///< node j
  Scalar rest_length;         ///< [m]
  Vector3<Scalar> direction;  ///< unit vector from i to j; zero if the edge is too short
  Scalar length;              ///< [m]; 0 if the edge is too short
  [[nodiscard]] bool has_direction() const { return length > Scalar(0); }
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
            law_rest_lengths(specification, mesh, assembly_.elements()).template cast<Scalar>()) {}

  [[nodiscard]] Eigen::Index scratch_columns() const { return assembly_.scratch_columns(); }

  /// result += force(spring) on node i of every spring and its opposite on node j [N].
  template <class Force>
  void add_pairs(const State<Scalar>& state, const Force& force, Matrix3XRef<Scalar> scratch,
                 Matrix3XRef<Scalar> result) const {
    const auto kernel = [&](Eigen::Index e, std::array<Vector3<Scalar>, 2>& parts) {
      parts[0] = force(spring(state, e));
      parts[1] = -parts[0];
    };
    assembly_.template add<Scalar>(kernel, scratch, result);
  }

  /// Sum of value(spring), in the order of the edges.
  template <class Value>
  [[nodiscard]] Scalar sum(const State<Scalar>& state, const Value& value) const {
    Scalar total(0);
    for (Eigen::Index e = 0; e < rest_lengths_.size(); ++e) total += value(spring(state, e));
    return total;
  }

 private:
  [[nodiscard]] Spring<Scalar> spring(const State<Scalar>& state, Eigen::Index e) const {
    using std::sqrt;
    const int first = assembly_.elements()(0, e);
    const int second = assembly_.elements()(1, e);
    const Scalar rest_length = rest_lengths_[e];
    const Vector3<Scalar> difference = state.positions.col(second) - state.positions.col(first);
    const Scalar squared_length = difference.squaredNorm();
    const Scalar shortest = Scalar(kMinLengthRatio) * rest_length;
    if (!(squared_length > shortest * shortest)) {
      return {first, second, rest_length, Vector3<Scalar>::Zero(), Scalar(0)};
    }
    const Scalar length = sqrt(squared_length);
    return {first, second, rest_length, Vector3<Scalar>(difference / length), length};
  }

  ElementAssembly<2> assembly_;
  VectorX<Scalar> rest_lengths_;  ///< [m]
};

}  // namespace weft::forces
