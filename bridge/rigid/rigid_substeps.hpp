#pragma once

// Tested by tests/bridge/rigid/rigid_substeps_test.cpp, tests/bridge/implicit/fast_body_impact_test.cpp.

#include <vector>

#include <BulletCollision/BroadphaseCollision/btDispatcher.h>

#include <weft/bridge/bullet/precision.hpp>
#include <weft/bridge/rigid/movable_object.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

/// Dynamic bodies that Bullet has moved already, during a step that cloth divides into substeps: they go back to where the
/// step began, and on by one substep at a time, with the velocities that cloth leaves them.
class RigidSubsteps {
 public:
  /// time_step: of the whole step [s]. The bodies go back at once.
  RigidSubsteps(const std::vector<MovableObject>& bodies, btScalar time_step, int num_substeps);
  /// Before the first substep: gravity of a body that rests on cloth alone acts in each substep alike. All of it in the first would
  /// be a blow on the cloth, and no pressure in the others. Not for what flies or bounces: Bullet's steps of that lose no energy.
  /// number: in bodies. dispatcher: or nullptr.
  void share_out_gravity(std::size_t number, btDispatcher* dispatcher);
  /// Moves each to where it is at the end of the substep without cloth.
  void begin_substep();
  void end_substep();
  /// Goes through substeps that are left because all cloth has stopped. Bodies that contacts hold, and articulated links, stand where
  /// Bullet has put them; it turns their new velocities into motion.
  void finish();
  /// The pose of a body at the beginning of the substep.
  [[nodiscard]] const btTransform& start_of(const MovableObject& body) const;

 private:
  struct Entry {
    MovableObject body;
    btTransform moved;        ///< by Bullet, over the whole step
    btTransform start;        ///< of the substep
    btTransform alone;        ///< at the end of the substep, without cloth
    btVector3 fall{0, 0, 0};  ///< what gravity adds to the velocity in each substep [m/s]
    bool is_held = false;     ///< cloth has changed its last velocity and not its position
  };

  std::vector<Entry> entries_;
  int num_left_;
  btScalar substep_time_;  ///< [s]
};

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
