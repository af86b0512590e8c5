#pragma once

#include <weft/custom_forces/force_law.hpp>
#include <weft/custom_forces/laws/damping/body_damping.hpp>
#include <weft/mesh/cloth_mesh.hpp>

namespace weft::forces {

/// What is left of the velocities without radial motion, translations and rigid rotations.
template <class Nodes>
class Swirl {
 public:
  using Number = typename Nodes::Number;
  using Vector = Vector3<Number>;

  explicit Swirl(const Nodes& nodes) : nodes_(nodes), body_(body_motion(nodes)) {
    Matrix3<Number> matrix = Matrix3<Number>::Constant(Number(0));
    Vector momentum = Vector::Constant(Number(0));
    for (const int node : nodes.free) {
      const Number m = nodes.mass(node);
      const Vector e = radial(node);
      momentum += m * tangential(node, e);
      const Vector me = m * e;
      for (int i = 0; i < 3; ++i) {
        matrix(i, i) += m;
        for (int j = 0; j < 3; ++j) matrix(i, j) -= me[i] * e[j];
      }
    }
    shift_ = solve_body<Number>(matrix, momentum);
  }

  [[nodiscard]] Vector velocity(int node) const {
    const Vector e = radial(node);
    return tangential(node, e) - without(shift_, e);
  }

 private:
  static Vector without(const Vector& v, const Vector& e) { return v - e * Number(e.dot(v)); }

  /// e: from the centre to the node, length 1; 0 for a node at the centre.
  [[nodiscard]] Vector radial(int node) const {
    using std::sqrt;
    constexpr double kCenterRadius = 1e-6;  // of the radius of gyration [-]
    const Vector r = nodes_.position(node) - body_.center;
    const Number square = r.dot(r);
    const Number least =
        Number(0.5 * kCenterRadius * kCenterRadius) * body_.inertia_trace / body_.mass;
    if (square <= least) return Vector::Constant(Number(0));
    return r / Number(sqrt(square));
  }

  /// y: the velocity without rigid motion and radial part.
  [[nodiscard]] Vector tangential(int node, const Vector& e) const {
    return without(nodes_.velocity(node) - body_.velocity - body_.spin(nodes_.position(node)), e);
  }

  const Nodes& nodes_;
  BodyMotion<Number> body_;
  Vector shift_;  ///< t [m/s]
};

/// The swirl of a body about its centre of mass decays: centre against rim, not the body's own spin.
///
///   f = -M rate Pi v     Pi projects, orthogonally in the inner product of the masses, on what is
///                        left of v without radial motion of single nodes, translations and rigid
///                        rotations
///   power = -rate sum m |Pi v|^2     alone: Pi v decays as exp(-rate t), the rest of v stays
///
/// So P and L stay, a rigid spin is untouched, a breathing motion is untouched, and a torsional mode
/// (tangential, P = L = 0) decays at exactly the rate. Rigid rotations are orthogonal to radial
/// motion and, about the centre of mass, to translations, so they split off first:
///
///   w = v - v_c - omega x r       y = w - e (e . w)            e = r / |r|
///   z = y - (t - e (e . t)) = Pi v,   (sum m (1 - e e^T)) t = sum m y
///
/// A velocity-level law: v -= (1 - exp(-h rate)) Pi v is its exact action over a time h. Nodes
/// within 1e-6 of the body's radius of gyration of the centre have no radial direction: e = 0.
/// Only free nodes count and feel forces. On a line the swirl is all motion across it that is not
/// rigid.
///
/// Symbols  rate  1 / tau, tau the time constant  [1/s]  >= 0
/// Source   own derivation
/// Checked  contract tests; rotation_damping
template <class Scalar>
class TorsionalRotationDamping final : public ForceLaw<Scalar> {
 public:
  static const LawInfo kInfo;

  TorsionalRotationDamping(const LawSpecification& specification, const ClothMesh& mesh);

  [[nodiscard]] const LawInfo& info() const noexcept override { return kInfo; }
  void add_forces(const State<Scalar>& state, Matrix3XRef<Scalar> scratch,
                  Matrix3XRef<Scalar> forces) const override;
  void add_stiffness_product(const State<Scalar>& state, ConstMatrix3XRef<Scalar> displacements,
                             Matrix3XRef<Scalar> scratch,
                             Matrix3XRef<Scalar> product) const override;
  void add_damping_product(const State<Scalar>& state, ConstMatrix3XRef<Scalar> velocity_changes,
                           Matrix3XRef<Scalar> scratch, Matrix3XRef<Scalar> product) const override;
  [[nodiscard]] Scalar non_conservative_power(const State<Scalar>& state) const override;
  void advance_velocities(const State<Scalar>& state, Scalar time_step,
                          Matrix3XRef<Scalar> velocities) const override;

 private:
  BodyDamping<Scalar, Swirl> damping_;
};

extern template class TorsionalRotationDamping<float>;
extern template class TorsionalRotationDamping<double>;

}  // namespace weft::forces
