#include <weft/fast_solver/newton/node_supports.hpp>

#include <cmath>

#include <Eigen/LU>

#include <weft/core/index.hpp>

namespace weft::fast {
template <class Scalar>
void NodeSupports<Scalar>::load(std::span<const NodeSupport<Scalar>> given) {
  given_ = given;
  states_.assign(given.size(), {});
}

template <class Scalar>
void NodeSupports<Scalar>::lift(const NodeArrays<Scalar>& starts,
                                NodeArrays<Scalar>& positions) const {
  for (const NodeSupport<Scalar>& one : given_) {
    const Vector3<Scalar> fall =
        at_node(positions, one.node) - at_node(starts, one.node) - one.motion;
    positions.row(one.node) -= std::min(Scalar(0), one.normal.dot(fall)) * one.normal.transpose();
  }
}

template <class Scalar>
Vector3<Scalar> NodeSupports<Scalar>::motion_of(const NodeSupport<Scalar>& one,
                                                const std::vector<Body>& bodies,
                                                Vector6 Body::*motion) {
  if (one.body < 0) return Vector3<Scalar>::Zero();
  const Vector6& displacement = bodies[at(one.body)].*motion;
  return displacement.template head<3>() + displacement.template tail<3>().cross(one.lever_arm);
}

// [N] Along the normal.
template <class Scalar>
Scalar NodeSupports<Scalar>::push_of(const NodeSupport<Scalar>& one,
                                     const Vector3<Scalar>& position,
                                     const std::vector<Body>& bodies, Vector6 Body::*motion) {
  const Scalar gap = one.normal.dot(position - motion_of(one, bodies, motion)) - one.offset;
  return one.stiffness * std::max(Scalar(0), -gap);
}

template <class Scalar>
Vector3<Scalar> NodeSupports<Scalar>::slip_of(const NodeSupport<Scalar>& one,
                                              const NodeArrays<Scalar>& positions,
                                              const NodeArrays<Scalar>& starts,
                                              const std::vector<Body>& bodies,
                                              Vector6 Body::*motion) {
  const Vector3<Scalar> slip = at_node(positions, one.node) - at_node(starts, one.node) -
                               one.motion - motion_of(one, bodies, motion);
  return slip - one.normal.dot(slip) * one.normal;
}

template <class Scalar>
Vector3<Scalar> NodeSupports<Scalar>::force_of(std::size_t support,
                                               const NodeArrays<Scalar>& positions,
                                               const NodeArrays<Scalar>& starts,
                                               const std::vector<Body>& bodies) const {
  const NodeSupport<Scalar>& one = given_[support];
  const State& state = states_[support];
  Vector3<Scalar> force =
      push_of(one, at_node(positions, one.node), bodies, &Body::motion) * one.normal;
  const Scalar bound = one.friction * state.push;
  if (!(bound > 0)) return force;
  const Vector3<Scalar> slip = slip_of(one, positions, starts, bodies, &Body::motion);
  return force - bound / std::max(slip.norm(), state.least_slip) * slip;
}

template <class Scalar>
void NodeSupports<Scalar>::add_forces(NodeRange nodes, const NodeArrays<Scalar>& positions,
                                      const NodeArrays<Scalar>& starts,
                                      const std::vector<Body>& bodies,
                                      NodeArrays<Scalar>& forces) const {
  for (std::size_t k = 0; k < given_.size(); ++k) {
    const int node = given_[k].node;
    if (node < nodes.begin || node >= nodes.end) continue;
    forces.row(node) += force_of(k, positions, starts, bodies).transpose();
  }
}

template <class Scalar>
double NodeSupports<Scalar>::energy(const NodeArrays<Scalar>& positions,
                                    const NodeArrays<Scalar>& starts,
                                    const std::vector<Body>& bodies, Vector6 Body::*motion) const {
  double sum = 0;
  for (std::size_t k = 0; k < given_.size(); ++k) {
    const NodeSupport<Scalar>& one = given_[k];
    const State& state = states_[k];
    const Scalar push = push_of(one, at_node(positions, one.node), bodies, motion);
    sum += 0.5 * static_cast<double>(push * push / one.stiffness);
    const Scalar bound = one.friction * state.push;
    if (!(bound > 0)) continue;
    const Scalar slip = slip_of(one, positions, starts, bodies, motion).norm();
    const Scalar least = state.least_slip;
    const Scalar path = slip < least ? slip * slip / (2 * least) : slip - least / 2;
    sum += static_cast<double>(bound * path);
  }
  return sum;
}

template <class Scalar>
Matrix3<float> NodeSupports<Scalar>::stiffness_of(std::size_t support) const {
  const NodeSupport<Scalar>& one = given_[support];
  const State& state = states_[support];
  const Vector3<float> normal = one.normal.template cast<float>();
  const float along = state.is_pressed ? static_cast<float>(one.stiffness) : 0.0F;
  const float across = state.is_pressed ? state.drag : 0.0F;
  return across * Matrix3<float>::Identity() + (along - across) * normal * normal.transpose();
}

template <class Scalar>
void NodeSupports<Scalar>::add_products(const NodeArrays<float>& displacements,
                                        Floats6 Body::*motion, NodeArrays<float>& product,
                                        std::vector<Body>& bodies,
                                        Floats6 Body::*body_product) const {
  for (std::size_t k = 0; k < given_.size(); ++k) {
    const NodeSupport<Scalar>& one = given_[k];
    Vector3<float> displacement = at_node(displacements, one.node);
    const Vector3<float> lever_arm = one.lever_arm.template cast<float>();
    if (one.body >= 0) {
      const Floats6& of_body = bodies[at(one.body)].*motion;
      displacement -= of_body.template head<3>() + of_body.template tail<3>().cross(lever_arm);
    }
    const Vector3<float> force = stiffness_of(k) * displacement;
    product.row(one.node) += force.transpose();
    if (one.body < 0) continue;
    Floats6& sum = bodies[at(one.body)].*body_product;
    sum.template head<3>() -= force;
    sum.template tail<3>() -= lever_arm.cross(force);
  }
}

template <class Scalar>
void NodeSupports<Scalar>::add_reactions(const NodeArrays<Scalar>& positions,
                                         const NodeArrays<Scalar>& starts,
                                         std::vector<Body>& bodies, Floats6 Body::*result) const {
  for (std::size_t k = 0; k < given_.size(); ++k) {
    const NodeSupport<Scalar>& one = given_[k];
    if (one.body < 0) continue;
    const Vector3<float> force = force_of(k, positions, starts, bodies).template cast<float>();
    Floats6& sum = bodies[at(one.body)].*result;
    sum.template head<3>() -= force;
    sum.template tail<3>() -= one.lever_arm.template cast<float>().cross(force);
  }
}

template <class Scalar>
void NodeSupports<Scalar>::invert_blocks(const BlockArrays& given, const VectorX<float>& inertia,
                                         float factor, BlockArrays& inverse) const {
  for (std::size_t k = 0; k < given_.size();) {
    const int i = given_[k].node;
    Matrix3<float> block;
    block << given(i, 0), given(i, 3), given(i, 5), given(i, 3), given(i, 1), given(i, 4),
        given(i, 5), given(i, 4), given(i, 2);
    block.diagonal().array() += inertia[i];
    for (; k < given_.size() && given_[k].node == i; ++k) block += stiffness_of(k);
    const Matrix3<float> result = factor * block.inverse();
    if (!result.allFinite()) continue;
    inverse.row(i) << result(0, 0), result(1, 1), result(2, 2), result(0, 1), result(1, 2),
        result(2, 0);
  }
}

template class NodeSupports<float>;
template class NodeSupports<double>;

}  // namespace weft::fast
