#pragma once

// Tested by tests/bridge/snapshot_test.cpp.

#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>

#include <weft/bridge/snapshot/object_table.hpp>
#include <weft/bridge/solver.hpp>
#include <weft/core/state_archive.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

/// All objects of a world, and what a solver knows of its soft bodies.
class WorldState {
 public:
  WorldState(btSoftRigidDynamicsWorld& world, SoftBodySolver& solver)
      : world_(&world), solver_(&solver), objects_(world) {}

  /// Throws Error for an object that no snapshot can have.
  void check() const;
  void serialize(StateArchive& archive);
  /// Whether a body's solver need not be made again (FastBodyState::is_fresh()).
  [[nodiscard]] static bool is_fresh(const SoftBodySolver& solver, const btSoftBody& body);

 private:
  void check_objects(StateArchive& archive) const;
  void serialize_body(StateArchive& archive, btSoftBody& body);
  void serialize_laws(StateArchive& archive, btSoftBody& body);
  void serialize_fast(StateArchive& archive, btSoftBody& body);
  void serialize_contact(StateArchive& archive, btSoftBody& body);
  void serialize_joints(StateArchive& archive);
  /// A solver that has no history, of the mesh and the laws that the body has. Throws Error for a body that was torn and whose
  /// laws were not set since.
  void renew_fast(const btSoftBody& body);

  btSoftRigidDynamicsWorld* world_;
  SoftBodySolver* solver_;
  ObjectTable objects_;
};

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
