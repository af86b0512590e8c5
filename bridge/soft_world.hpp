#pragma once

// Tested by tests/bridge/solver_checks_test.cpp, tests/bridge/contact/rigid_response_test.cpp.

#include <memory>

#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>

#include <weft/bridge/solver.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

/// Settings of a soft-body world that Bullet keeps in three places.
struct SoftWorldSettings {
  Vector3<double> gravity{0, -9.81, 0};  ///< [m/s^2] of rigid bodies; cloth has its gravity law
  /// Voxel edge [m] of Bullet's distance field of rigid shapes. A surface of curvature radius R is
  /// met with an error of about voxel^2 / (8 R); Bullet's default of 0.25 m puts a cloth 4 mm into
  /// a sphere of 2 m.
  double distance_field_voxel = 0.05;
};

/// A btSoftRigidDynamicsWorld with Weft's solver and all that it needs, for programs without a
/// world of their own.
class SoftWorld {
 public:
  explicit SoftWorld(const SoftWorldSettings& settings);
  ~SoftWorld();
  SoftWorld(const SoftWorld&) = delete;
  SoftWorld& operator=(const SoftWorld&) = delete;

  [[nodiscard]] btSoftRigidDynamicsWorld& world() { return *world_; }
  [[nodiscard]] btSoftBodyWorldInfo& info() { return world_->getWorldInfo(); }
  [[nodiscard]] SoftBodySolver& solver() { return *solver_; }

  /// The world owns the objects and deletes them with itself.
  btSoftBody& add(std::unique_ptr<btSoftBody> body);
  /// A shape that needs others, or arrays, to live as long owns them: shared_ptr's aliasing.
  btRigidBody& add(std::unique_ptr<btRigidBody> body, std::shared_ptr<btCollisionShape> shape);

  /// One step of time_step [s], without Bullet's interpolation. Bullet rounds it to single
  /// precision.
  void step(double time_step);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
  std::unique_ptr<SoftBodySolver> solver_;
  std::unique_ptr<btSoftRigidDynamicsWorld> world_;
  long num_steps_ = 0;
};

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
