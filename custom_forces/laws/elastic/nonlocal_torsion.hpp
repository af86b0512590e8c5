#pragma once

#include <vector>

#include <weft/custom_forces/assembly/element_force.hpp>
#include <weft/custom_forces/force_law.hpp>

namespace weft::forces {

/// Connections between nodes that are not neighbors: a far node p keeps its direction in the local
/// frame of a node c, so that a surface that was folded over finds its way back.
///
///   E = kappa phi^2 / 2
///   phi    angle between the direction d from c to p and R d0, 0 to pi
///   d0     d at the rest shape, in c's frame
///   R      c's frame (e1, n x e1, n): n normal of the polygon of c's ring, e1 along a weighted sum
///          of the ring's directions, made perpendicular to n
///
/// The torque kappa phi that turns d towards R d0 acts on p and c as a couple of forces; the opposite
/// couple acts on the ring, through the derivative of the frame. So the law is the gradient of its
/// energy and conserves momentum and angular momentum; and it knows the front from the back: the
/// mirror image of a fold is not at rest. Nothing acts along d, and nothing at phi = pi.
///
/// Symbols  kappa  stiffness  [N m/rad]  >= 0
/// Errors   InvalidArgument at construction for a node without triangles or with several fans of
///          them, and for nodes in one place; a ring crushed to kMinRatio of its rest area, or a
///          far node closer than kMinRatio of its rest distance, exerts no force
/// Source   Werth 2008 (non-local connections with a moderate torsion constant); the frame and the
///          energy are our own
/// Checked  contract tests; flipped_flap, held_centre
template <class Scalar>
class NonlocalTorsion final : public ForceLaw<Scalar> {
 public:
  static const LawInfo kInfo;
  /// Ring nodes that make the frame; of a larger ring evenly spaced ones.
  static constexpr int kMaxRing = 8;
  static constexpr double kMinRatio = 1e-6;  ///< see Errors [-]

  NonlocalTorsion(const LawSpecification& specification, const ClothMesh& mesh);

  [[nodiscard]] const LawInfo& info() const noexcept override { return kInfo; }
  [[nodiscard]] Eigen::Index scratch_columns() const override { return ties_.scratch_columns(); }
  void add_forces(const State<Scalar>& state, Matrix3XRef<Scalar> scratch,
                  Matrix3XRef<Scalar> forces) const override;
  void add_stiffness_product(const State<Scalar>& state, ConstMatrix3XRef<Scalar> displacements,
                             Matrix3XRef<Scalar> scratch,
                             Matrix3XRef<Scalar> product) const override;
  [[nodiscard]] Scalar potential_energy(const State<Scalar>& state) const override;

 private:
  static constexpr int kNodes = 2 + kMaxRing;  ///< c, p, ring; unused places hold c
  /// The frame of a connection, as its ring makes it.
  struct Frame {
    int ring_size = 0;
    bool is_open = false;
    Eigen::Matrix<Scalar, kMaxRing, 1> weights;  ///< of the ring's directions in e1 [1/m]
    Vector3<Scalar> rest_direction;              ///< d0 [-]
    Scalar smallest_area{0};                     ///< squared length of the area vector [m^4]
    Scalar shortest{0};                          ///< squared distance of p [m^2]
  };
  template <class Number>
  struct Pose;

  [[nodiscard]] static typename ElementForce<Scalar, kNodes>::Elements elements(
      const LawSpecification& specification, const ClothMesh& mesh);
  [[nodiscard]] Frame rest_frame(const ClothMesh& mesh, Eigen::Index e, bool is_open) const;
  template <class Number>
  [[nodiscard]] static bool pose_of(const Frame& frame, const ElementState<Number, kNodes>& tie,
                                    Pose<Number>& pose);
  template <class Number>
  void add_tie(Eigen::Index e, const ElementState<Number, kNodes>& tie,
               ElementForces<Number, kNodes>& parts) const;

  ElementForce<Scalar, kNodes> ties_;
  std::vector<Frame> frames_;
  Scalar stiffness_;  ///< [N m/rad]
};

extern template class NonlocalTorsion<float>;
extern template class NonlocalTorsion<double>;

}  // namespace weft::forces
