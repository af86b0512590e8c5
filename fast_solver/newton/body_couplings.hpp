#pragma once

// Tested by tests/bridge/rigid/multibody_test.cpp.

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Cholesky>

#include <weft/fast_solver/linked_body.hpp>
#include <weft/fast_solver/node_constraints.hpp>

namespace weft::fast {

/// The inertia that couples links of one multibody to each other: the blocks of the inverse operational-space inertia (Khatib
/// 1987) beside its diagonal, over h^2.
template <class Scalar>
class BodyCouplings {
 public:
  using Body = LinkedBody<Scalar>;
  using Vector6 = typename Body::Vector6;
  using Floats6 = typename Body::Floats6;

  void load(std::span<const InertiaCoupling<Scalar>> couplings, Scalar per_square) {
    blocks_.clear();
    for (const InertiaCoupling<Scalar>& given : couplings) {
      blocks_.push_back(
          {given.first, given.second, (per_square * given.inertia).template cast<float>()});
    }
  }
  /// force += inertia times motion, for all bodies.
  template <class Motion>
  void add_forces(std::vector<Body>& bodies, Motion Body::*motion, Floats6 Body::*force) const {
    for (const Block& block : blocks_) {
      Body& first = bodies[at(block.first)];
      Body& second = bodies[at(block.second)];
      first.*force += block.inertia * (second.*motion).template cast<float>();
      second.*force += block.inertia.transpose() * (first.*motion).template cast<float>();
    }
  }
  /// A body that is coupled to a linked one moves with it.
  void spread_links(std::vector<Body>& bodies) const {
    for (Body& body : bodies) body.is_coupled = false;
    for (const Block& block : blocks_) {
      Body& first = bodies[at(block.first)];
      Body& second = bodies[at(block.second)];
      first.is_coupled = first.is_coupled || second.is_linked;
      second.is_coupled = second.is_coupled || first.is_linked;
    }
    for (Body& body : bodies) body.is_linked = body.is_linked || body.is_coupled;
  }
  /// [J]
  [[nodiscard]] double energy(const std::vector<Body>& bodies, Vector6 Body::*motion) const {
    double sum = 0;
    for (const Block& block : blocks_) {
      const Vector6& first = bodies[at(block.first)].*motion;
      const Vector6& second = bodies[at(block.second)].*motion;
      sum += static_cast<double>(first.dot(block.inertia.template cast<Scalar>() * second));
    }
    return sum;
  }
  /// The shift of all nodes and linked bodies that leaves no net force [m]. of_nodes: the residual force on all nodes [N];
  /// node_inertia: theirs over h^2 [N/m]. Unlike that of rigid bodies, the inertia of links has directions.
  [[nodiscard]] Vector3<double> shift(std::vector<Body>& bodies, const Vector3<double>& of_nodes,
                                      double node_inertia) const {
    for (Body& body : bodies) {
      body.present_residual = -(body.inertia * body.motion.template cast<float>());
    }
    for (Body& body : bodies) body.correction = -body.motion.template cast<float>();
    add_forces(bodies, &Body::correction, &Body::present_residual);
    Vector3<double> left = of_nodes;
    Matrix3<double> inertia = node_inertia * Matrix3<double>::Identity();
    for (const Body& body : bodies) {
      if (!body.is_linked) continue;
      left += body.present_residual.template head<3>().template cast<double>();
      inertia += body.inertia.template topLeftCorner<3, 3>().template cast<double>();
    }
    for (const Block& block : blocks_) {
      if (!bodies[at(block.first)].is_linked) continue;
      const Matrix3<double> mixed =
          block.inertia.template topLeftCorner<3, 3>().template cast<double>();
      inertia += mixed + mixed.transpose();
    }
    return inertia.ldlt().solve(left);
  }

 private:
  struct Block {
    int first;
    int second;
    Eigen::Matrix<float, 6, 6> inertia;
  };
  static std::size_t at(int i) { return static_cast<std::size_t>(i); }

  std::vector<Block> blocks_;
};

}  // namespace weft::fast
