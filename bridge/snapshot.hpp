#pragma once

// Tested by tests/bridge/snapshot_test.cpp.

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>

#include <weft/bridge/solver.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

/// The state of a world between two steps, to go back to: rollback of a networked game, steps backwards, a level that starts
/// again. What follows a restore() has the bits of what followed save().
///
///   weft::bridge::Snapshot snapshot;
///   snapshot.save(world, solver);
///   for (int step = 0; step < 8; ++step) world.stepSimulation(1 / 60.0f, 0);
///   snapshot.restore(world, solver);
///
/// It has soft bodies, with laws or without, and rigid bodies: positions, velocities, forces, sleep, masses and pins, and
/// what Weft's solvers know of the steps before. It has no settings: laws, shapes, friction, gravity, callbacks, joints and
/// bodies themselves must be those that the world had, which is checked as far as Bullet tells.
///
/// Bullet keeps the order of pairs and of tree nodes from step to step and does not let one save it. save() and restore()
/// make both anew, and forget contact points between rigid bodies, which the next step finds again; a run that is saved may
/// therefore differ in its last bits from one that is not.
class Snapshot {
 public:
  Snapshot() = default;
  /// bytes() of another one.
  explicit Snapshot(std::vector<std::byte> bytes) : bytes_(std::move(bytes)) {}

  /// In place of what it had; its memory is kept. Throws Error for a world with links of a btMultiBody, with soft bodies that
  /// have clusters or a pose to match, and for a body whose solver would have to be made again and has torn
  /// (SoftBodySolver::replace_laws() with its mesh comes before). Nothing has changed then.
  /// A body whose pins, masses or springs have changed since the last snapshot is factorized anew, which takes as long as
  /// attach_fast() does.
  void save(btSoftRigidDynamicsWorld& world, SoftBodySolver& solver);
  /// Throws Error for a snapshot of another world, or of bodies that have torn or have other laws; the world is of no use then
  /// until another snapshot is restored.
  void restore(btSoftRigidDynamicsWorld& world, SoftBodySolver& solver) const;

  [[nodiscard]] const std::vector<std::byte>& bytes() const { return bytes_; }
  [[nodiscard]] std::size_t size() const { return bytes_.size(); }  ///< [bytes]

  /// Only writes, and leaves the world as it is: what goes on may have other bits than what comes back.
  /// For a world whose torn bodies get their laws anew, and that is restored then.
  void write(btSoftRigidDynamicsWorld& world, SoftBodySolver& solver);
  /// Whether a body's solver need not be made again.
  [[nodiscard]] static bool is_fresh(const SoftBodySolver& solver, const btSoftBody& body);

 private:
  std::vector<std::byte> bytes_;
};

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
