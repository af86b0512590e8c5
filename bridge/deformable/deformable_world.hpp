#pragma once

// Tested by tests/bridge/deformable/deformable_faults_test.cpp, tests/bridge/deformable/deformable_contact_test.cpp.

#include <memory>

#include <weft/bridge/deformable/bullet_deformable.hpp>

#include <weft/bridge/cloth_body.hpp>
#include <weft/bridge/deformable/deformable_solver.hpp>
#include <weft/core/state_archive.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

/// How Bullet's deformable world advances the laws.
enum class DeformableScheme {
  kExplicit,  ///< forces of position explicit, dampers implicit; the step is limited by stiffness
  kImplicit,  ///< everything implicit, one linear solve per Newton iteration
};

struct DeformableWorldSettings {
  Vector3<double> gravity{0, -9.81, 0};  ///< [m/s^2] of rigid bodies; cloth has its gravity law
  DeformableScheme scheme = DeformableScheme::kExplicit;
  int newton_iterations = 1;  ///< of an implicit step, >= 1
  /// Contact iterations per step, >= 1; they start from nothing in every step.
  int contact_iterations = 10;
  /// Voxel edge [m] of Bullet's distance field of rigid shapes, see SoftWorldSettings.
  double distance_field_voxel = 0.05;
};

/// A btDeformableMultiBodyDynamicsWorld with Weft's solver and all that it needs, for programs
/// without a world of their own.
class DeformableWorld {
 public:
  /// Throws InvalidArgument for settings out of their domain.
  explicit DeformableWorld(const DeformableWorldSettings& settings);
  ~DeformableWorld();
  DeformableWorld(const DeformableWorld&) = delete;
  DeformableWorld& operator=(const DeformableWorld&) = delete;

  [[nodiscard]] btDeformableMultiBodyDynamicsWorld& world() { return *world_; }
  [[nodiscard]] btSoftBodyWorldInfo& info() { return world_->getWorldInfo(); }
  [[nodiscard]] DeformableSolver& solver() { return *solver_; }
  [[nodiscard]] DeformableForces& forces() { return solver_->forces(); }

  /// The world owns the objects and deletes them with itself; a soft body goes through
  /// prepare_for_deformable_world().
  btSoftBody& add(std::unique_ptr<btSoftBody> body);
  /// A shape that needs others, or arrays, to live as long owns them: shared_ptr's aliasing.
  btRigidBody& add(std::unique_ptr<btRigidBody> body, std::shared_ptr<btCollisionShape> shape);

  /// The state between two steps, written or read back: soft and rigid bodies, and what the laws know.
  /// Bullet keeps the order of its trees, pairs and contact points from step to step and does not let one save
  /// it, so that only a world that has just been made, with the same bodies, goes on with the same bits as another
  /// one that was just made and read the same state.
  void serialize(StateArchive& archive);

  /// One step of time_step [s], without Bullet's interpolation, in the precision of btScalar.
  void step(double time_step);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
  std::unique_ptr<DeformableSolver> solver_;
  std::unique_ptr<btDeformableMultiBodyDynamicsWorld> world_;
};

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
