#pragma once

#include <algorithm>
#include <vector>

#include <weft/custom_forces/assembly/element_force.hpp>
#include <weft/custom_forces/force_law.hpp>
#include <weft/custom_forces/laws/elastic/straight_lines.hpp>

namespace weft::forces {

/// Bending of a line: a torsion spring in every node between two others.
///
///   E = kappa (s theta - theta0)^2 / 2          f = -kappa (s theta - theta0) s dtheta/dx
///   theta  turning angle at C of the way A -> C -> B, 0 (straight) to pi (folded back)
///   s      1 or -1: which way the line turns. Only where theta0 != 0 does it matter: there it comes
///          from the normal of C's triangles, 1 where the front is the convex side; a node without
///          triangles has no front, and s = 1
///   theta0 s theta at the rest shape
///   kappa  (k' d'^2 + k'' d''^2) / 2, with k' = k, k'' = ratio k and the rest lengths d' of A-C and
///          d'' of C-B as lever arms
///
/// With d' = d'' = d and ratio = 1 a small turn gives the ends forces k d theta along their normals
/// and the centre the opposite of both, proportional to k' d' + k'' d''. A straight line of such
/// triples with spacing d is a beam of rigidity k d^3.
///
/// Symbols  k      stiffness   [N/(m rad)]  >= 0
///          ratio  side_ratio  [1]          >= 0, default 1: stiffness of the second side over the
///                                          first
/// Errors   InvalidArgument at construction; a triple with a side shorter than kMinLengthRatio of its
///          rest length, or folded back so far that no direction is left, exerts no force
/// Source   Werth 2008 (torsion: three points, lever arms, end and centre forces); the energy is our
///          own and gives those forces for small turns
/// Checked  contract tests; torsion_beam
template <class Scalar>
class Torsion final : public ForceLaw<Scalar> {
 public:
  static const LawInfo kInfo;

  Torsion(const LawSpecification& specification, const ClothMesh& mesh);

  [[nodiscard]] const LawInfo& info() const noexcept override { return kInfo; }
  [[nodiscard]] Eigen::Index scratch_columns() const override {
    return std::max(straight_.scratch_columns(), bent_.scratch_columns());
  }
  void add_forces(const State<Scalar>& state, Matrix3XRef<Scalar> scratch,
                  Matrix3XRef<Scalar> forces) const override;
  void add_stiffness_product(const State<Scalar>& state, ConstMatrix3XRef<Scalar> displacements,
                             Matrix3XRef<Scalar> scratch,
                             Matrix3XRef<Scalar> product) const override;
  void add_rest_stiffness(const State<Scalar>& rest,
                          std::vector<PairStiffness<Scalar>>& pairs) const override;
  [[nodiscard]] Scalar potential_energy(const State<Scalar>& state) const override;

 private:
  struct RestLines;
  Torsion(const RestLines& lines, const ClothMesh& mesh);

  /// Twice the area vector of the triangles around the centre of a bent line; zero without triangles.
  [[nodiscard]] Vector3<Scalar> normal_at(const State<Scalar>& state, Eigen::Index e) const;
  template <class Number>
  [[nodiscard]] LineTurn<Number> turn_of(Eigen::Index e, const ElementState<Number, 3>& line) const;
  /// s of a bent line.
  [[nodiscard]] Scalar side(const State<Scalar>& state, Eigen::Index e,
                            const ElementState<Scalar, 3>& line) const;
  template <class Number>
  void add_line(const State<Scalar>& state, Eigen::Index e, const ElementState<Number, 3>& line,
                ElementForces<Number, 3>& parts) const;

  StraightLines<Scalar> straight_;
  ElementForce<Scalar, 3> bent_;
  VectorX<Scalar> stiffness_;          ///< kappa of bent lines [N m]
  VectorX<Scalar> rest_angles_;        ///< theta0 of bent lines [rad], not 0
  Matrix2X<Scalar> squared_shortest_;  ///< of both sides of bent lines, the least length [m^2]
  std::vector<Eigen::Index>
      first_face_;  ///< faces of bent line e's centre: first_face_[e] ... [e + 1]
  Triangles faces_;
};

extern template class Torsion<float>;
extern template class Torsion<double>;

}  // namespace weft::forces
