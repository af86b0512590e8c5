#pragma once

#include <vector>

#include <weft/custom_forces/assembly/batched_assembly.hpp>
#include <weft/custom_forces/force_law.hpp>

namespace weft::forces {

/// Bending of a surface: torsion springs in the hinges between its triangles.
///
///   E = k (theta - theta0)^2 / 2     f = -k (theta - theta0) dtheta/dx
///   theta  signed angle of the hinge in (-pi, pi]: 0 flat, positive where the front is convex
///   theta0 its value at the rest shape
///   k      from the plate rigidity D:
///          * four-sided cells (a grid, regular or not) are cut both ways, each of which gives half of
///            k = D A / (S : S). A is the area of the hinge's two triangles and S the tensor that
///            gives the hinge's angle on a surface of curvature K, theta = K : S. Rectangular cells
///            (square ones: k = D) are exactly the isotropic plate of energy D (K : K) / 2 per area,
///            Poisson's ratio 0. One way of cutting alone has the same energy on a given smooth
///            surface, but every second node would give way until three quarters of D are left, with
///            Poisson's ratio -1/3.
///          * other triangles: k = D l / h (l length of the edge, h mean height of its triangles),
///            exact on cylinders for equilateral triangles, whose Poisson's ratio is -1/3.
///          Times factor at a clamp: where all nodes that the angle depends on are pinned but one.
///          Half a cell's curvature lies in front of the clamp, which makes it 2.
///
/// Symbols  D      rigidity      [N m]  >= 0
///          factor clamp_factor  [1]    >= 0, default 2
/// Errors   InvalidArgument at construction for triangles that make no surface or have no area;
///          a hinge with a triangle smaller than kMinAreaRatio of its rest area exerts no force
/// Source   A / (S : S) and cutting both ways: own derivation, for a regular grid splits K : K
///          between its legs and diagonals and this weight gives each its part; l / h: Feng et al. 2022
/// Checked  contract tests; plate_rigidity, cantilever
template <class Scalar>
class HingeTorsion final : public ForceLaw<Scalar> {
 public:
  static const LawInfo kInfo;
  using Gradients = Eigen::Matrix<Scalar, 12, Eigen::Dynamic>;

  HingeTorsion(const LawSpecification& specification, const ClothMesh& mesh);

  [[nodiscard]] const LawInfo& info() const noexcept override { return kInfo; }
  [[nodiscard]] Eigen::Index scratch_columns() const override {
    return hinges_.scratch_columns(2);  // positions and displacements
  }
  void add_forces(const State<Scalar>& state, Matrix3XRef<Scalar> scratch,
                  Matrix3XRef<Scalar> forces) const override;
  void add_stiffness_product(const State<Scalar>& state, ConstMatrix3XRef<Scalar> displacements,
                             Matrix3XRef<Scalar> scratch,
                             Matrix3XRef<Scalar> product) const override;
  void add_rest_stiffness(const State<Scalar>& rest,
                          std::vector<PairStiffness<Scalar>>& pairs) const override;
  [[nodiscard]] Scalar potential_energy(const State<Scalar>& state) const override;

  /// The hinges' nodes, 4 x m: the ends of the edge, then the far corners of its triangles.
  [[nodiscard]] const BatchedAssembly<4>::Elements& hinges() const { return hinges_.elements(); }
  /// sqrt(k) dtheta/dx of each hinge, by its nodes, 12 x m [sqrt(N/m)]; 0 for a hinge that exerts no force for its area. Squares of
  /// these are the law's stiffness but for what the moment adds. positions: 3 x n [m].
  void get_gradients(ConstMatrix3XRef<Scalar> positions, Eigen::Ref<Gradients> gradients) const;

  /// Smallest triangle whose normal is still trusted, as a fraction of its rest area [-].
  static constexpr double kMinAreaRatio = 1e-6;

 private:
  struct Numbers;
  [[nodiscard]] Numbers numbers() const;

  BatchedAssembly<4> hinges_;
  // In the order in which the assembly computes the hinges.
  VectorX<Scalar> stiffness_;            ///< k [N m]
  VectorX<Scalar> rest_angles_;          ///< theta0 [rad]
  VectorX<Scalar> smallest_normals_[2];  ///< least squared length of both normals [m^4]
};

extern template class HingeTorsion<float>;
extern template class HingeTorsion<double>;

}  // namespace weft::forces
