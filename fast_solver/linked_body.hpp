#pragma once

#include <array>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include <weft/core/types.hpp>
#include <weft/fast_solver/newton/anderson_history.hpp>

namespace weft::fast {

/// A node that moves with a rigid body, in all directions or along a normal only.
struct BodyLink {
  int node;
  int body;
  Vector3<float> lever_arm;  ///< [m]
  Vector3<float> normal;     ///< zero: in all directions

  /// The motion of the node's place with the body's motion: of its center, and about it.
  [[nodiscard]] Vector3<float> motion_with(const Eigen::Matrix<float, 6, 1>& motion) const {
    return along_link(motion.head<3>() + motion.tail<3>().cross(lever_arm));
  }
  /// The transpose: adds to the force on the body, and about its center, what pushes the node.
  void add_force(const Vector3<float>& force, Eigen::Matrix<float, 6, 1>& sum) const {
    const Vector3<float> felt = along_link(force);
    sum.head<3>() += felt;
    sum.tail<3>() += lever_arm.cross(felt);
  }
  [[nodiscard]] Vector3<float> along_link(const Vector3<float>& vector) const {
    if (normal.isZero(0)) return vector;
    return normal.dot(vector) * normal;
  }
};

/// What a step solves for of a rigid body that is coupled both ways: motions and forces of its center, and about it.
template <class Scalar>
struct LinkedBody {
  using Vector6 = Eigen::Matrix<Scalar, 6, 1>;
  using Floats6 = Eigen::Matrix<float, 6, 1>;
  using Matrix6 = Eigen::Matrix<float, 6, 6>;

  Vector6 motion = Vector6::Zero();       ///< beyond that of the body left alone [m, rad]
  Vector6 last_motion = Vector6::Zero();  ///< where the iteration began
  Vector6 last_result = Vector6::Zero();  ///< of the iteration before
  std::array<Vector6, AndersonHistory<Scalar>::kMemory> result_changes{};
  Vector6 unmoved = Vector6::Zero();  ///< the same where nothing has moved in the step
  Vector6 motion_alone = Vector6::Zero();
  Matrix6 inertia = Matrix6::Zero();  ///< over h^2
  Eigen::LLT<Matrix6> stiffness;      ///< with what is linked to it
  // Vectors of conjugate gradients, as those of nodes.
  Floats6 step, residual, direction, direction_product;
  Floats6 correction, correction_product, coarse_product;
  Floats6 present_residual;
  bool is_linked = false;  ///< any node, in the present round
  bool is_held = false;    ///< by what is not among bodies
};

}  // namespace weft::fast
