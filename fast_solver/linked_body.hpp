#pragma once

// Tested by tests/fast_solver/implicit_solver_test.cpp.

#include <array>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include <weft/core/types.hpp>
#include <weft/fast_solver/newton/anderson_history.hpp>

namespace weft::fast {

/// A node that moves with a rigid body, in all directions or along a normal only.
struct BodyLink {
  using Vector6 = Eigen::Matrix<float, 6, 1>;

  int node;
  int body;
  Vector3<float> lever_arm;  ///< [m]
  Vector3<float> normal;     ///< zero: in all directions
  bool is_dragged = false;   ///< along the surface, by friction

  /// The displacement of the body's material at the node for a generalized displacement of the body.
  [[nodiscard]] Vector3<float> motion_there(const Vector6& motion) const {
    return motion.head<3>() + motion.tail<3>().cross(lever_arm);
  }
  /// The transpose: adds a force there to the generalized force on the body.
  void add_force_there(const Vector3<float>& force, Vector6& sum) const {
    sum.head<3>() += force;
    sum.tail<3>() += lever_arm.cross(force);
  }
  /// The displacement of the node that the link enforces.
  [[nodiscard]] Vector3<float> motion_with(const Vector6& motion) const {
    return along_link(motion_there(motion));
  }
  /// The transpose: of a force on the node.
  void add_force(const Vector3<float>& force, Vector6& sum) const {
    add_force_there(along_link(force), sum);
  }
  /// The same of preconditioners, in which a dragged node goes along.
  [[nodiscard]] Vector3<float> motion_carried(const Vector6& motion) const {
    return is_dragged ? motion_there(motion) : motion_with(motion);
  }
  void add_force_carried(const Vector3<float>& force, Vector6& sum) const {
    add_force_there(is_dragged ? force : along_link(force), sum);
  }
  [[nodiscard]] Vector3<float> along_surface(const Vector3<float>& vector) const {
    return vector - normal.dot(vector) * normal;
  }
  [[nodiscard]] Vector3<float> along_link(const Vector3<float>& vector) const {
    if (normal.isZero(0)) return vector;
    return normal.dot(vector) * normal;
  }
};

/// The unknowns of a two-way coupled rigid body: generalized displacements and forces, about its center.
template <class Scalar>
struct LinkedBody {
  using Vector6 = Eigen::Matrix<Scalar, 6, 1>;
  using Floats6 = Eigen::Matrix<float, 6, 1>;
  using Matrix6 = Eigen::Matrix<float, 6, 6>;

  Vector6 motion = Vector6::Zero();       ///< relative to the motion of a free body [m, rad]
  Vector6 last_motion = Vector6::Zero();  ///< motion at the start of the iteration
  Vector6 last_result = Vector6::Zero();  ///< for the iteration before
  std::array<Vector6, AndersonHistory<Scalar>::kMemory> result_changes{};
  Vector6 unmoved = Vector6::Zero();  ///< motion for which nothing has moved in the step
  Vector6 motion_alone = Vector6::Zero();
  Matrix6 inertia = Matrix6::Zero();  ///< over h^2
  Eigen::LLT<Matrix6> stiffness;      ///< with what is linked to it
  // Vectors of conjugate gradients, as those of nodes.
  Floats6 step, residual, direction, direction_product;
  Floats6 correction, correction_product, coarse_product;
  Floats6 carried_residual;
  Floats6 present_residual;
  bool is_linked = false;   ///< any node, in the present iteration
  bool is_link = false;     ///< of a multibody
  bool is_coupled = false;  ///< to a body that is linked
  bool is_held = false;     ///< by what is not among bodies
};

}  // namespace weft::fast
