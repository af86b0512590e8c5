#pragma once

// Tested by tests/custom_forces/laws/damping/rotation_damping_test.cpp, tests/custom_forces/laws/damping/acceleration_damping_test.cpp.

#include <limits>
#include <type_traits>
#include <vector>

#include <weft/core/eigen_alignment.hpp>

#include <Eigen/Geometry>

#include <weft/core/tangent.hpp>
#include <weft/custom_forces/force_law.hpp>

namespace weft::forces {

/// The number in which a law sums over a whole body: a sum of thousands of floats, taken about a
/// centre that lies far from the origin, would not keep momentum as well as its terms do.
template <class Scalar>
using Wide = std::conditional_t<std::is_same_v<Scalar, float>, double, Scalar>;

/// The free nodes of a body as they are, in wide numbers.
template <class Scalar>
struct BodyNodes {
  using Number = Wide<Scalar>;
  const State<Scalar>& state;
  const std::vector<int>& free;         ///< node indices, sorted
  ConstMatrix3XRef<Scalar> velocities;  ///< 3 x n [m/s], in place of the state's

  [[nodiscard]] Number mass(int node) const { return Number(state.masses[node]); }
  [[nodiscard]] Vector3<Number> position(int node) const {
    return state.positions.col(node).template cast<Number>();
  }
  [[nodiscard]] Vector3<Number> velocity(int node) const {
    return velocities.col(node).template cast<Number>();
  }
};

/// The same with positions that move along displacements, 3 x n [m], for derivatives.
template <class Scalar>
struct MovingBodyNodes {
  using Number = Tangent<Wide<Scalar>>;
  BodyNodes<Scalar> nodes;
  const std::vector<int>& free;
  ConstMatrix3XRef<Scalar> displacements;

  [[nodiscard]] Number mass(int node) const { return Number(nodes.mass(node)); }
  [[nodiscard]] Vector3<Number> position(int node) const {
    const Vector3<Wide<Scalar>> x = nodes.position(node);
    const Vector3<Wide<Scalar>> b = displacements.col(node).template cast<Wide<Scalar>>();
    return {Number(x[0], b[0]), Number(x[1], b[1]), Number(x[2], b[2])};
  }
  [[nodiscard]] Vector3<Number> velocity(int node) const {
    const Vector3<Wide<Scalar>> v = nodes.velocity(node);
    return {Number(v[0]), Number(v[1]), Number(v[2])};
  }
};

/// Relative size of a determinant below which a body counts as collinear [-], in units of the
/// trace's cube. A rod's is the square of thickness over length, so rods thinner than 1e-7 of their
/// length are treated as lines; rounding moves the determinant by a few eps.
inline constexpr double kCollinear = 64 * std::numeric_limits<double>::epsilon();

/// x with A x = b for a symmetric, positive definite 3 x 3 matrix A, or for the matrix
/// a (1 - u u^T) of a collinear body, where b has no part along u: there x = b / a. 0 for A = 0.
template <class Number>
[[nodiscard]] Vector3<Number> solve_body(const Matrix3<Number>& a, const Vector3<Number>& b) {
  const Number trace = a(0, 0) + a(1, 1) + a(2, 2);
  if (!(trace > Number(0))) return Vector3<Number>::Constant(Number(0));
  const Vector3<Number> column0 = a.col(0);
  const Vector3<Number> minor = Vector3<Number>(a.col(1)).cross(Vector3<Number>(a.col(2)));
  const Number determinant = column0.dot(minor);
  if (determinant <= Number(kCollinear) * trace * trace * trace)
    return b * Number(Number(2) / trace);
  // L D L^T: stable without pivoting for a positive definite matrix.
  const Number l10 = a(1, 0) / a(0, 0);
  const Number l20 = a(2, 0) / a(0, 0);
  const Number d1 = a(1, 1) - l10 * a(1, 0);
  const Number l21 = (a(2, 1) - l20 * a(1, 0)) / d1;
  const Number d2 = a(2, 2) - l20 * a(2, 0) - l21 * l21 * d1;
  const Number y1 = b[1] - l10 * b[0];
  const Number y2 = b[2] - l20 * b[0] - l21 * y1;
  const Number x2 = y2 / d2;
  const Number x1 = y1 / d1 - l21 * x2;
  const Number x0 = b[0] / a(0, 0) - l10 * x1 - l20 * x2;
  return {x0, x1, x2};
}

/// The rigid motion that carries a body's momenta.
template <class Number>
struct BodyMotion {
  Number mass{0};                    ///< of the free nodes [kg]
  Vector3<Number> center;            ///< of mass [m]
  Vector3<Number> velocity;          ///< of the centre [m/s]
  Vector3<Number> angular_momentum;  ///< L about the centre [kg m^2/s]
  Vector3<Number> angular_velocity;  ///< omega = I^-1 L [rad/s]
  Number inertia_trace{0};           ///< of I, twice the sum of m r^2 [kg m^2]

  /// omega x r at a position [m/s].
  [[nodiscard]] Vector3<Number> spin(const Vector3<Number>& position) const {
    return angular_velocity.cross(Vector3<Number>(position - center));
  }
};

/// Sums run in the order of the nodes. A collinear body does not turn about its own line, a single
/// node not at all.
template <class Nodes>
[[nodiscard]] BodyMotion<typename Nodes::Number> body_motion(const Nodes& nodes) {
  using Number = typename Nodes::Number;
  const Vector3<Number> zero = Vector3<Number>::Constant(Number(0));
  BodyMotion<Number> body{Number(0), zero, zero, zero, zero, Number(0)};
  if (nodes.free.empty()) return body;
  for (const int node : nodes.free) {
    const Number m = nodes.mass(node);
    body.mass += m;
    body.center += m * nodes.position(node);
    body.velocity += m * nodes.velocity(node);
  }
  body.center /= body.mass;
  body.velocity /= body.mass;
  Matrix3<Number> inertia = Matrix3<Number>::Constant(Number(0));
  for (const int node : nodes.free) {
    const Number m = nodes.mass(node);
    const Vector3<Number> r = nodes.position(node) - body.center;
    const Vector3<Number> v = nodes.velocity(node) - body.velocity;
    const Vector3<Number> mr = m * r;
    body.angular_momentum += mr.cross(v);
    const Number square = mr.dot(r);
    for (int i = 0; i < 3; ++i) {
      inertia(i, i) += square;
      for (int j = 0; j < 3; ++j) inertia(i, j) -= mr[i] * r[j];
    }
  }
  body.inertia_trace = inertia(0, 0) + inertia(1, 1) + inertia(2, 2);
  body.angular_velocity = solve_body<Number>(inertia, body.angular_momentum);
  return body;
}

}  // namespace weft::forces
