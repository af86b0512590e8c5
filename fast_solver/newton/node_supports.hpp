#pragma once

// Tested by tests/fast_solver/newton/node_supports_test.cpp, tests/bridge/implicit/cloth_between_test.cpp.

#include <algorithm>
#include <span>
#include <vector>

#include <weft/core/types.hpp>
#include <weft/fast_solver/linked_body.hpp>
#include <weft/fast_solver/network/node_arrays.hpp>
#include <weft/fast_solver/node_constraints.hpp>
#include <weft/fast_solver/threads/node_partition.hpp>

namespace weft::fast {

/// The surfaces behind nodes that a rigid body presses on: springs along their normals that only push (penalty method), with
/// Coulomb friction that is a drag of lagged size, linear below a least slip (Li et al. 2020, section 5). A node is one
/// constraint only, and that is the body's, which gets what the springs bear.
template <class Scalar>
class NodeSupports {
 public:
  using Vector6 = Eigen::Matrix<Scalar, 6, 1>;
  using Floats6 = Eigen::Matrix<float, 6, 1>;
  using Body = LinkedBody<Scalar>;

  /// given: ascending by node, and valid until the next load().
  void load(std::span<const NodeSupport<Scalar>> given);
  [[nodiscard]] bool empty() const { return given_.empty(); }
  /// Takes the fall of nodes behind their surfaces from the initial guess: predicted deep in what backs them, they would seem to
  /// be pressed by many times the weight of the body.
  void lift(const NodeArrays<Scalar>& starts, NodeArrays<Scalar>& positions) const;
  [[nodiscard]] std::span<const NodeSupport<Scalar>> all() const { return given_; }

  /// Bounds of friction by the present forces, and the least slip with full friction by what resists the motion of each node:
  /// resistance(node) [N/m]. In the first iteration all are taken to be pressed, for that is why they were given.
  template <class Resistance>
  void update(const NodeArrays<Scalar>& positions, const NodeArrays<Scalar>& starts,
              const std::vector<Body>& bodies, bool is_first, const Resistance& resistance) {
    for (std::size_t k = 0; k < given_.size(); ++k) {
      const NodeSupport<Scalar>& one = given_[k];
      State& state = states_[k];
      const Scalar push = push_of(one, at_node(positions, one.node), bodies, &Body::motion);
      state.change = push - state.push;
      state.push = push;
      state.least_slip = one.friction * push / (kStiffestDrag * resistance(one.node));
      const Scalar slip = slip_of(one, positions, starts, bodies, &Body::motion).norm();
      const Scalar bound = one.friction * push;
      state.drag =
          static_cast<float>(bound > 0 ? bound / std::max(slip, state.least_slip) : Scalar(0));
      state.is_pressed = is_first || push > 0;
    }
  }
  /// By how much more one of them pushes than at the update before [N].
  [[nodiscard]] Scalar change_of(std::size_t support) const { return states_[support].change; }

  /// Adds the forces on nodes to those of some nodes [N].
  void add_forces(NodeRange nodes, const NodeArrays<Scalar>& positions,
                  const NodeArrays<Scalar>& starts, const std::vector<Body>& bodies,
                  NodeArrays<Scalar>& forces) const;
  /// The force of one of them on its node [N].
  [[nodiscard]] Vector3<Scalar> force_of(std::size_t support, const NodeArrays<Scalar>& positions,
                                         const NodeArrays<Scalar>& starts,
                                         const std::vector<Body>& bodies) const;
  /// [J]
  [[nodiscard]] double energy(const NodeArrays<Scalar>& positions, const NodeArrays<Scalar>& starts,
                              const std::vector<Body>& bodies, Vector6 Body::*motion) const;
  /// Adds the stiffness of supports times displacements to the products of nodes and of bodies behind them.
  void add_products(const NodeArrays<float>& displacements, Floats6 Body::*motion,
                    NodeArrays<float>& product, std::vector<Body>& bodies,
                    Floats6 Body::*body_product) const;
  /// Takes the forces on nodes from those of bodies behind them.
  void add_reactions(const NodeArrays<Scalar>& positions, const NodeArrays<Scalar>& starts,
                     std::vector<Body>& bodies, Floats6 Body::*result) const;
  /// The inverse blocks of nodes with supports, times a factor. given: without inertia and supports.
  void invert_blocks(const BlockArrays& given, const VectorX<float>& inertia, float factor,
                     BlockArrays& inverse) const;

 private:
  /// The stiffness along and across the normal, of the present state [N/m].
  [[nodiscard]] Matrix3<float> stiffness_of(std::size_t support) const;

  struct State {
    Scalar push = 0;        ///< along the normal at the last update [N]
    Scalar change = 0;      ///< since the update before [N]
    Scalar least_slip = 0;  ///< [m]
    float drag = 0;         ///< [N/m]
    bool is_pressed = false;
  };
  /// Over what resists the motion of a node: what is held by friction creeps by less than a hundredth of what springs yield.
  static constexpr Scalar kStiffestDrag = 300;

  [[nodiscard]] static Vector3<Scalar> motion_of(const NodeSupport<Scalar>& one,
                                                 const std::vector<Body>& bodies,
                                                 Vector6 Body::*motion);
  [[nodiscard]] static Scalar push_of(const NodeSupport<Scalar>& one,
                                      const Vector3<Scalar>& position,
                                      const std::vector<Body>& bodies, Vector6 Body::*motion);
  [[nodiscard]] static Vector3<Scalar> slip_of(const NodeSupport<Scalar>& one,
                                               const NodeArrays<Scalar>& positions,
                                               const NodeArrays<Scalar>& starts,
                                               const std::vector<Body>& bodies,
                                               Vector6 Body::*motion);

  std::span<const NodeSupport<Scalar>> given_;
  std::vector<State> states_;
};

extern template class NodeSupports<float>;
extern template class NodeSupports<double>;

}  // namespace weft::fast
