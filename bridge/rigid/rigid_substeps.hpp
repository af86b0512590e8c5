#pragma once

// Tested by tests/bridge/implicit/fast_body_impact_test.cpp.

#include <vector>

#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <weft/bridge/bullet/precision.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

/// Dynamic bodies that Bullet has moved already, during a step that cloth takes in parts: they go back to where the step
/// began, and on by one part at a time, with the velocities that cloth leaves them.
class RigidSubsteps {
 public:
  /// time_step: of the whole step [s]. The bodies go back at once.
  RigidSubsteps(const std::vector<btRigidBody*>& bodies, btScalar time_step, int num_parts);
  /// To where each is at the end of the part if left alone.
  void begin_part();
  void end_part();
  /// Bodies that joints or contacts hold stand where Bullet has put them; it turns their new velocities into motion.
  void finish();
  /// Where a body is at the beginning of the part.
  [[nodiscard]] const btTransform& start_of(const btRigidBody& body) const;

 private:
  struct Entry {
    btRigidBody* body;
    btTransform moved;     ///< by Bullet, over the whole step
    btTransform start;     ///< of the part
    btTransform alone;     ///< at the end of the part, without cloth
    bool is_held = false;  ///< cloth has changed its velocity and not its place
  };

  std::vector<Entry> entries_;
  btScalar part_;  ///< [s]
};

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
