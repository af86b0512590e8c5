#pragma once

// Tested by tests/custom_forces/laws/damping/rotation_damping_test.cpp, tests/contract/law_contract_test.cpp.

#include <cmath>
#include <vector>

#include <weft/custom_forces/laws/damping/body_motion.hpp>
#include <weft/custom_forces/laws/damping/free_nodes.hpp>

namespace weft::forces {

/// Damping of one part of a body's motion: f = -M rate Q v, with Q(x) a projector that is
/// symmetric in the inner product of the masses and splits off that part of the velocities.
///
/// Everything a velocity-level law needs follows from Q: the power is -rate times twice the part's
/// kinetic energy, the exact action over a time h is v -= (1 - exp(-h rate)) Q v, the damping
/// product is the law itself, and the stiffness product is its derivative with x + b eps.
///
/// Part is a template over the nodes (BodyNodes or MovingBodyNodes) with a constructor from them,
/// which takes the sums, and `Vector3<Number> velocity(int node) const`, (Q v)_node [m/s].
///
/// Only free nodes count in sums and feel forces. Sums run in the order of the nodes, so no thread
/// count can change them; a pass over a body costs less than its springs.
template <class Scalar, template <class> class Part>
class BodyDamping {
 public:
  /// rate [1/s]
  BodyDamping(double rate, const ClothMesh& mesh) : rate_(static_cast<Scalar>(rate)), free_(mesh) {}

  /// result -= m rate Q velocities [N]
  void subtract(const State<Scalar>& state, ConstMatrix3XRef<Scalar> velocities,
                Matrix3XRef<Scalar> result) const {
    const BodyNodes<Scalar> nodes{state, free_.of(state.positions.cols()), velocities};
    const Part<BodyNodes<Scalar>> part(nodes);
    for (const int node : nodes.free) {
      const Vector3<Wide<Scalar>> force =
          (Wide<Scalar>(rate_) * nodes.mass(node)) * part.velocity(node);
      result.col(node) -= force.template cast<Scalar>();
    }
  }

  /// result -= m rate (dQ/dx displacements) v [N]
  void subtract_derivative(const State<Scalar>& state, ConstMatrix3XRef<Scalar> displacements,
                           Matrix3XRef<Scalar> result) const {
    using Nodes = MovingBodyNodes<Scalar>;
    const std::vector<int>& free = free_.of(state.positions.cols());
    const Nodes nodes{{state, free, state.velocities}, free, displacements};
    const Part<Nodes> part(nodes);
    for (const int node : nodes.free) {
      const Wide<Scalar> factor = Wide<Scalar>(rate_) * nodes.nodes.mass(node);
      const Vector3<typename Nodes::Number> v = part.velocity(node);
      for (int axis = 0; axis < 3; ++axis) {
        result(axis, node) -= static_cast<Scalar>(factor * v[axis].rate);
      }
    }
  }

  /// -rate sum m |Q v|^2 [W]
  [[nodiscard]] Scalar power(const State<Scalar>& state) const {
    const BodyNodes<Scalar> nodes{state, free_.of(state.positions.cols()), state.velocities};
    const Part<BodyNodes<Scalar>> part(nodes);
    Wide<Scalar> sum(0);
    for (const int node : nodes.free) sum += nodes.mass(node) * part.velocity(node).squaredNorm();
    return static_cast<Scalar>(-Wide<Scalar>(rate_) * sum);
  }

  /// velocities -= (1 - exp(-time_step rate)) Q velocities
  void advance(const State<Scalar>& state, Scalar time_step, Matrix3XRef<Scalar> velocities) const {
    const BodyNodes<Scalar> nodes{state, free_.of(state.positions.cols()), velocities};
    const Part<BodyNodes<Scalar>> part(nodes);
    const Wide<Scalar> factor = loss(Wide<Scalar>(rate_) * Wide<Scalar>(time_step));
    for (const int node : nodes.free) {
      const Vector3<Wide<Scalar>> v = nodes.velocity(node) - factor * part.velocity(node);
      velocities.col(node) = v.template cast<Scalar>();
    }
  }

 private:
  static Wide<Scalar> loss(const Wide<Scalar>& exponent) {
    using std::exp;
    return Wide<Scalar>(1) - Wide<Scalar>(exp(Wide<Scalar>(-exponent)));
  }

  Scalar rate_;  ///< [1/s]
  FreeNodes free_;
};

}  // namespace weft::forces
