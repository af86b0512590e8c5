#pragma once

// Tested by tests/fast_solver/newton/sliding_friction_test.cpp, tests/fast_solver/newton/coulomb_drag_test.cpp.

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <weft/core/index.hpp>
#include <weft/core/types.hpp>
#include <weft/fast_solver/network/node_arrays.hpp>

namespace weft::fast {

/// Coulomb friction of the nodes that slide, as a drag B / |s| on their slip s, with B their bound: unlike a constant force it never
/// drives a node, however wrong B still is. Below a least slip the drag is constant, and friction the gradient of a Huber
/// function: B (|s| - least / 2), or B s^2 / (2 least).
///
/// Along the slip that drag is too stiff as a linearization, because B does not grow with the slip. With all of it each iteration of
/// Newton's method would leave the same share of the error (iteratively reweighted least squares). Its second derivative,
/// B / |s| (I - u u^T), u = s / |s|, ends that, and could throw a node back and forth across the slip at which it stops (Alart
/// and Curnier 1991). So a node whose slip has turned around gets half as much of the relief u u^T, every time.
template <class Scalar>
class SlidingFriction {
 public:
  /// A drag over what else resists the motion of a node, at most. With less, a node that begins to slide is too fast, by mu g h over
  /// this. With much more, conjugate gradients would see nothing else.
  static constexpr double kStiffest = 300;

  void resize(Eigen::Index num_nodes) {
    for (VectorX<Scalar>* numbers : {&drags_, &bounds_, &stiffest_drags_})
      numbers->setZero(num_nodes);
    for (Matrix3X<float>* vectors : {&forces_, &reliefs_}) vectors->setZero(3, num_nodes);
    num_turns_.assign(static_cast<std::size_t>(num_nodes), 0);
  }
  /// No node has turned around yet.
  void begin_step() {
    std::fill(num_turns_.begin(), num_turns_.end(), 0);
    reliefs_.setZero();
  }

  /// A node has no friction, until more is said.
  void release(int node) { set_force(node, Vector3<float>::Zero()); }
  /// It has a constant force [N].
  void set_force(int node, const Vector3<float>& force) {
    bounds_[node] = drags_[node] = 0;
    forces_.col(node) = force;
    reliefs_.col(node).setZero();
  }
  /// It has a bound [N]. resistance: what else resists its motion, > 0 [N/m]; rounding: the error of its slip [m].
  void set_bound(int node, Scalar bound, Scalar resistance, Scalar rounding) {
    const Scalar least =
        std::max(bound / (Scalar(kStiffest) * resistance), Scalar(kRoundings) * rounding);
    bounds_[node] = bound;
    stiffest_drags_[node] = least > 0 ? bound / least : 0;
  }
  /// The bound changes, and the stiffest drag does not.
  void add_to_bound(int node, Scalar change) {
    bounds_[node] = std::max(Scalar(0), bounds_[node] + change);
  }
  /// Makes its drag that for a slip of an expected size [m], and its force that at a slip.
  void expect_slip(int node, const Vector3<Scalar>& slip, Scalar expected) {
    const Scalar bound = bounds_[node];
    const Scalar size = std::max(expected, least_slip(node));
    // A bound that was 0 when it was set has no least slip, and its node may not have moved.
    drags_[node] = bound > 0 && size > 0 ? bound / size : Scalar(0);
    forces_.col(node) = (-drags_[node] * slip).template cast<float>();
    reliefs_.col(node).setZero();
  }
  /// The same at the slip that is expected. On what does not give way (is_relieved) the drag is relieved along the slip.
  void set_slip(int node, const Vector3<Scalar>& slip, bool is_relieved) {
    const Vector3<float> direction = slip.template cast<float>();
    const bool turns = reliefs_.col(node).dot(direction) < 0;
    if (turns) ++num_turns_[at(node)];
    const Scalar size = slip.norm();
    expect_slip(node, slip, size);
    if (!is_relieved || !(drags_[node] > 0) || !(size > least_slip(node))) return;
    const auto share = static_cast<float>(1 - least_slip(node) / size);
    const float relief =
        std::ldexp(share * static_cast<float>(drags_[node]), -num_turns_[at(node)]);
    reliefs_.col(node) = std::sqrt(relief) / static_cast<float>(size) * direction;
  }

  [[nodiscard]] const VectorX<Scalar>& drags() const { return drags_; }  ///< for each node [N/m]
  [[nodiscard]] Vector3<float> force(int node) const { return forces_.col(node); }  ///< [N]
  /// The friction of a node that has slipped so far [N].
  [[nodiscard]] Vector3<Scalar> force_at(int node, const Vector3<Scalar>& slip) const {
    const Scalar size = std::max(slip.norm(), least_slip(node));
    if (!(bounds_[node] > 0 && size > 0)) return Vector3<Scalar>::Zero();
    return -(bounds_[node] / size) * slip;
  }
  /// Whether a node's friction is less than its bound: it holds the node, but for less than the least slip.
  [[nodiscard]] bool holds(int node) const {
    return static_cast<Scalar>(forces_.col(node).norm()) < Scalar(kBelowBound) * bounds_[node];
  }
  /// Returns the energy that friction has taken once a node has slipped so far [J].
  [[nodiscard]] Scalar energy(int node, Scalar slip) const {
    const Scalar bound = bounds_[node];
    if (!(bound > 0)) return 0;
    const Scalar least = least_slip(node);
    return slip < least ? stiffest_drags_[node] * slip * slip / 2 : bound * (slip - least / 2);
  }

  /// Takes the relief from the product of a node's row with its drag.
  void relieve_product(int node, const NodeArrays<float>& displacements,
                       NodeArrays<float>& product) const {
    const auto relief = reliefs_.col(node);
    product.row(node) -= displacements.row(node).dot(relief) * relief.transpose();
  }
  /// The inverse of a node's block with its drag becomes that with the relief (Sherman and Morrison 1950). Both are multiplied by a
  /// factor.
  void relieve_inverse(int node, float factor, BlockArrays& inverse) const {
    const Vector3<float> relief = reliefs_.col(node);
    if (relief.isZero(0)) return;
    Matrix3<float> block;
    block << inverse(node, 0), inverse(node, 3), inverse(node, 5), inverse(node, 3),
        inverse(node, 1), inverse(node, 4), inverse(node, 5), inverse(node, 4), inverse(node, 2);
    const Vector3<float> image = block * relief / factor;
    const float left = 1 - relief.dot(image);
    if (!(left > 0)) return;
    const Matrix3<float> more = factor / left * image * image.transpose();
    Eigen::Matrix<float, 1, 6> change;
    change << more(0, 0), more(1, 1), more(2, 2), more(0, 1), more(1, 2), more(2, 0);
    inverse.row(node) += change;
  }

 private:
  /// A share of a bound that is not all of it, however forces are rounded [-].
  static constexpr double kBelowBound = 1 - 1e-4;
  /// A drag must not make forces of rounding that are like its bound: so many times the rounding of slips is the least slip.
  static constexpr double kRoundings = 4;

  [[nodiscard]] Scalar least_slip(int node) const {
    return stiffest_drags_[node] > 0 ? bounds_[node] / stiffest_drags_[node] : Scalar(0);
  }

  VectorX<Scalar> drags_;           ///< for each sliding node [N/m]
  VectorX<Scalar> bounds_;          ///< by Coulomb's law [N]
  VectorX<Scalar> stiffest_drags_;  ///< the most that its drag may be [N/m]
  Matrix3X<float> forces_;          ///< [N]
  Matrix3X<float> reliefs_;         ///< r, of the stiffness - r r^T
  std::vector<int> num_turns_;      ///< of its slip in this step
};

}  // namespace weft::fast
